// What went wrong in textures, told to their authors: node, line, arguments, pixel.
#pragma once

#include "backends/textures/texture_replay.hpp"
#include "host/render/texture_faults.hpp"

#include <nlohmann/json_fwd.hpp>

#include <optional>
#include <string>

namespace diptych {

// The first evaluation of a kind of fault, met again on the host.
struct TextureFaultPlace {
    int x = 0, y = 0, sample = 0, bounce = 0;
    std::string node, function, file;
    int line = 0;  // where a value first was not finite, or of the loop that ran out; else where
                   // the function begins
    std::string arguments;  // "scale = 7, tint = (0.5, 0.75, 1)"
    std::string value;      // "(inf, nan, 0, 1)"
    int clamped = 0;        // indexes in this evaluation
};

struct TextureFaultReport {
    TextureFaults faults;
    std::array<std::optional<TextureFaultPlace>, TEXTURE_FAULT_COUNT> first;
};

// Traces the first pixels with faults again and runs their textures on the host. `backend` is the
// name of what rendered, uploaded with the scene.
TextureFaultReport find_texture_faults(Backend& backend, const std::string& name, SceneData& scene,
                                       const TextureFaults& faults);

// One line for each kind that occurred, in the order of TEXTURE_FAULT_*.
std::string texture_fault_text(const TextureFaultReport& report, int kind);
nlohmann::json texture_fault_json(const TextureFaultReport& report);

// "scale = 7, tint = (0.5, 0.75, 1)"
std::string arguments_text(const TextureFunction& function, const TextureStepValue& step);

// "(1, 2, 3)", or the number alone; of many, the first ones.
std::string text_of_numbers(const std::vector<double>& numbers, bool is_whole);

}  // namespace diptych
