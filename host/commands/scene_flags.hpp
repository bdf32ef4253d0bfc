// The flags that say which scene, seen how, on which device: shared by all commands that take a
// scene.
#pragma once

#include "backends/backend.hpp"
#include "host/scene/load.hpp"

#include <optional>
#include <string>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace diptych {

struct SceneFlags {
    std::string scene;  // empty: the demo scene
    LoadOptions load;
    std::string size = "512x512";
    std::string eye, target, up = "0,1,0";
    double fov_degrees = 45;
    bool is_lens_given = false;  // --up or --fov
    double environment_rotation_degrees = 0;
    int samples = 64;
    bool is_one_sequence = false;
    unsigned seed = 1;
    std::string bounces = "64";
    std::string filter = "blackman-harris";
};

struct DeviceFlags {
    std::string backend = "cpu";
    BackendOptions options;
    std::string memory = "512M";
    bool is_backend_given = false;
    bool takes_list = false;  // of several devices
};

// A value that is an empty text, as of a shell's unset variable, is an error.
void refuse_empty(CLI::Option* option);

void add_scene_flags(CLI::App& app, SceneFlags& flags);
void add_view_flags(CLI::App& app, SceneFlags& flags);  // without the scene's name
void add_device_flags(CLI::App& app, DeviceFlags& flags);
void add_device_options(CLI::App& app, DeviceFlags& flags);  // without --backend

// Throws std::runtime_error for what the flags alone show to be wrong: a render with an error or
// time target, or with --samples alone.
void check_scene_flags(const SceneFlags& flags, bool is_adaptive = false);
// Checks what the flags say and loads the scene, settings filled in: for a render with an error or
// time target, or with --samples alone. Throws std::runtime_error.
SceneData load_from_flags(const SceneFlags& flags, bool is_adaptive = false);
// What there is to say of the edited copy of generated code that is to run, if one is.
std::vector<std::string> generated_notices(const SceneData& scene, const DeviceFlags& flags);
BackendOptions options_from_flags(const DeviceFlags& flags);
// For commands that can use several devices: the flags with the backend that --device asks for.
DeviceFlags with_device_list(const DeviceFlags& flags);

// "640x480", "512M", "1,2.5,3": throw std::runtime_error that names the flag.
std::pair<int, int> parse_size(const std::string& text);
size_t parse_bytes(const std::string& flag, const std::string& text);

}  // namespace diptych
