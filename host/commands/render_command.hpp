// `diptych render`: a scene to pictures.
#pragma once

#include "host/commands/error_flags.hpp"
#include "host/commands/render_checkpoint.hpp"
#include "host/commands/scene_flags.hpp"
#include "host/image/image.hpp"
#include "host/render/render.hpp"

#include <atomic>
#include <optional>
#include <vector>

namespace diptych {

struct RenderCommand {
    SceneFlags scene;
    DeviceFlags device;
    ErrorFlags error;
    CheckpointFlags checkpoint;
    std::vector<std::string> outputs;
    std::string capture;  // file for the pixel's hits on textures
    std::string pixel;
    std::string json;
    std::string refresh;
    std::string preview;
    std::string view = "standard";
    image::WriteOptions write;
    bool is_audited = false;
    bool is_quiet = false;
    bool is_strict = false;
    bool is_reproducible = false;
    std::string command_line;
};

// "12,20": a pixel of a picture of that size; none for an empty text. Throws std::runtime_error.
std::optional<Pixel> parse_pixel(const std::string& text, const std::string& size);

// Flags of the pictures to write, for every command that renders to files.
void add_output_flags(CLI::App& app, RenderCommand& command);
// True once SIGINT or SIGTERM has come.
const std::atomic<bool>& watch_for_interrupts();

CLI::App* add_render_command(CLI::App& app, RenderCommand& command);

// 0: done; 130: interrupted, pictures written. Errors are thrown.
int run_render_command(const RenderCommand& command);

}  // namespace diptych
