#include "host/commands/debug_command.hpp"

#include "backends/textures/scratch_folder.hpp"
#include "backends/textures/subprocess.hpp"
#include "common/as_cpp/path_rows.hpp"
#include "host/commands/launch_file.hpp"
#include "host/commands/render_command.hpp"
#include "host/commands/texture_capture.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <set>
#include <stdexcept>
#include <unistd.h>

namespace diptych {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr const char* launch_file = ".vscode/launch.json";

int lines_of(const std::string& file)
{
    std::ifstream in(file);
    int lines = 0;
    for (std::string line; std::getline(in, line);) ++lines;
    return lines;
}

std::string node_names(const SceneData& scene, int material)
{
    std::set<std::string> names;
    for (const TextureAttachment& attachment : scene.textures.attachments)
        if (material < 0 || attachment.material == material) names.insert(attachment.node);
    return names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", "));
}

std::string materials_of(const SceneData& scene, const std::string& node)
{
    std::set<std::string> names;
    for (const TextureAttachment& attachment : scene.textures.attachments)
        if (attachment.node == node && attachment.material >= 0)
            names.insert(scene.material_names.at(size_t(attachment.material)));
    return fmt::format("{}", fmt::join(names, ", "));
}

// The material that the first sample of a pixel meets; -1: none.
int material_at(SceneData& scene, int x, int y)
{
    BackendOptions options;
    options.debug_textures = true;
    options.threads = 1;
    const std::unique_ptr<Backend> twin = make_backend("twin", options);
    twin->upload(scene);
    const WorkItem item{x, y, 0, 0};
    int triangle = -1;
    bool is_first = true;
    twin->trace({{&item, 1}, 1, 0}, [&](const StageState& state) {
        if (state.stage != STAGE_intersect || !is_first) return;
        triangle = int(state.planes[row_hit_triangle].at(0));
        is_first = false;
    });
    return triangle < 0 ? -1 : scene.triangles.at(size_t(triangle)).material;
}

std::string quoted(const std::string& word)
{
    const bool is_plain =
        !word.empty() && word.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWX"
                                                "YZ0123456789_./,:=+-") == std::string::npos;
    if (is_plain) return word;
    std::string text = "'";
    for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return text + "'";
}

// As gdb reads it, for which what follows " if " in a plain place is an expression to compute.
std::string gdb_breakpoint(const DebugStop& stop)
{
    if (stop.line == 0) return "break " + stop.function;
    if (quoted(stop.file) == stop.file) return fmt::format("break {}:{}", stop.file, stop.line);
    const bool has_quote = stop.file.find('\'') != std::string::npos;
    if (has_quote && stop.file.find_first_of(" \t\n\v\f\r") != std::string::npos)
        throw std::runtime_error(stop.file + ": gdb cannot be told of a file with both a quote and "
                                             "a space in its name; rename it, or use lldb");
    return has_quote ? fmt::format("break {}:{}", stop.file, stop.line)
                     : fmt::format("break -source '{}' -line {}", stop.file, stop.line);
}

std::string lldb_breakpoint(const DebugStop& stop)
{
    if (stop.line == 0) return "breakpoint set --name " + stop.function;
    std::string file;
    for (const char c : stop.file) file += c == '\'' ? std::string("'\"'\"'") : std::string(1, c);
    return fmt::format("breakpoint set --file '{}' --line {}", file, stop.line);
}

std::string node_of(const DebugCommand& command)
{
    std::string node;
    for (const std::string& texture : command.scene.load.textures) {
        if (texture.find('=') != std::string::npos) continue;
        if (!node.empty())
            throw std::runtime_error("--texture: nodes " + node + " and " + texture +
                                     "; name one to stop in");
        node = texture;
    }
    return node;
}

// The node that was asked for; without a name, the only one.
std::string node_in_use(const SceneData& scene, const std::string& asked)
{
    std::set<std::string> names;
    for (const TextureAttachment& attachment : scene.textures.attachments)
        names.insert(attachment.node);
    if (asked.empty() && names.size() == 1) return *names.begin();
    if (names.count(asked)) return asked;
    throw std::runtime_error(
        asked.empty()
            ? "--texture NODE: name the texture node to stop in; in use: " + node_names(scene, -1)
            : fmt::format("--texture {}: nothing in the scene uses such a texture node; "
                          "in use: {}",
                          asked, node_names(scene, -1)));
}

// What the debugger runs: the command line as it came, of `diptych render`, for one pixel.
std::vector<std::string> program_of(const DebugCommand& command)
{
    std::error_code error;
    std::vector<std::string> program = {fs::read_symlink("/proc/self/exe", error).string(),
                                        "render"};
    const auto is_ours = [](const std::string& name) {
        return name == "--line" || name == "--debugger" || name == "--execute";
    };
    for (size_t k = 2; k < command.words.size(); ++k) {
        const std::string& word = command.words[k];
        const size_t equals = word.find('=');
        const std::string name = word.substr(0, equals);
        const bool has_value = equals != std::string::npos;
        if (name == "--print" || name == "--vscode") continue;
        if (is_ours(name)) {
            if (!has_value) ++k;
        } else if (name == "--texture" && !has_value && k + 1 < command.words.size()) {
            const std::string& value = command.words[++k];
            if (value.find('=') != std::string::npos) program.insert(program.end(), {word, value});
        } else if (name == "--texture" && word.find('=', equals + 1) == std::string::npos) {
            continue;
        } else {
            program.push_back(word);
        }
    }
    const auto has = [&](const std::string& flag) {
        return std::ranges::any_of(command.words, [&](const std::string& word) {
            return word == flag || word.starts_with(flag + "=");
        });
    };
    if (!has("--backend")) program.insert(program.end(), {"--backend", "twin"});
    if (!has("--debug-textures")) program.push_back("--debug-textures");
    if (!has("--samples")) program.insert(program.end(), {"--samples", "1"});
    if (!has("--threads")) program.insert(program.end(), {"--threads", "1"});
    program.push_back("--quiet");
    return program;
}

// The texture's file and line, in a form that the C and C++ extension of VS Code takes.
json launch_configuration(const DebugCommand& command, const DebugStop& stop,
                          const std::vector<std::string>& program)
{
    json setup = json::array();
    for (const std::string& text : {std::string("set breakpoint pending on"), gdb_breakpoint(stop)})
        setup.push_back({{"text", text}});
    return {{"name", fmt::format("diptych: {} at {}", node_of(command), command.pixel)},
            {"type", "cppdbg"},
            {"request", "launch"},
            {"program", program.at(0)},
            {"args", std::vector<std::string>(program.begin() + 1, program.end())},
            {"cwd", fs::current_path().string()},
            {"MIMode", command.debugger == "lldb" ? "lldb" : "gdb"},
            {"setupCommands", setup}};
}

// Adds the configuration to the folder's launch file, in the place of an earlier one of that name.
void write_launch_file(const json& configuration)
{
    if (fs::exists(launch_file) && !std::ifstream(launch_file))
        throw std::runtime_error(std::string(launch_file) +
                                 ": cannot be read; change its permissions, or move it away");
    std::string text;
    try {
        text = with_configuration(text_of(launch_file), configuration);
    } catch (const std::runtime_error& error) {
        throw std::runtime_error(std::string(launch_file) + ": " + error.what());
    }
    fs::create_directories(fs::path(launch_file).parent_path());
    image::write_file_whole(launch_file, text);
    fmt::print("wrote {}\n", launch_file);
}

void check(const DebugCommand& command)
{
    if (command.debugger != "gdb" && command.debugger != "lldb")
        throw std::runtime_error("--debugger " + command.debugger + ": use gdb or lldb");
    if (!command.replay.empty()) return;
    if (command.scene.scene.empty())
        throw std::runtime_error("debug: no scene; name one with procedural textures");
    if (command.pixel.empty())
        throw std::runtime_error("debug: no pixel; give --pixel X,Y from the upper left");
    if (command.device.backend != "twin" && command.device.backend != "cpu" &&
        command.device.backend != "double")
        throw std::runtime_error("--backend " + command.device.backend +
                                 ": no debugger stops there; use twin, cpu or double");
}

// The capture again in this program, which prints what comes out.
std::vector<std::string> replay_program(const DebugCommand& command)
{
    std::error_code error;
    std::vector<std::string> program = {fs::read_symlink("/proc/self/exe", error).string(), "debug",
                                        "--replay", command.replay, "--print"};
    if (!command.scene.scene.empty()) program.push_back(command.scene.scene);
    const SceneFlags& flags = command.scene;
    for (const std::string& texture : flags.load.textures)
        if (texture.find('=') != std::string::npos)
            program.insert(program.end(), {"--texture", texture});
    for (const std::string& value : flags.load.texture_values)
        program.insert(program.end(), {"--set", value});
    if (flags.load.allow_outside) program.push_back("--allow-outside");
    const BackendOptions& options = command.device.options;
    if (!options.generated_dir.empty())
        program.insert(program.end(), {"--generated-dir", options.generated_dir});
    if (!options.use_generated.empty())
        program.insert(program.end(), {"--use-generated", options.use_generated});
    return program;
}

[[noreturn]] void become(const std::vector<std::string>& command)
{
    std::fflush(nullptr);
    std::vector<char*> words;
    for (const std::string& word : command) words.push_back(const_cast<char*>(word.c_str()));
    words.push_back(nullptr);
    execvp(words[0], words.data());
    throw std::runtime_error(command[0] + ": cannot be started; install it, choose another with " +
                             "--debugger, or see the command with --print");
}

void print_generated_notices(const SceneData& scene, const DeviceFlags& device)
{
    for (const std::string& line : generated_notices(scene, device))
        fmt::print(stderr, "notice: {}\n", line);
}

int replay(const DebugCommand& command, SceneFlags flags)
{
    const TextureCapture capture = read_capture(command.replay);
    SceneData scene = load_for_replay(capture, std::move(flags), command.replay);
    const BackendOptions options = options_from_flags(command.device);
    if (command.is_print) {
        print_generated_notices(scene, command.device);
        return print_replay(capture, scene, command.replay,
                            {options.generated_dir, options.use_generated});
    }
    std::string node = node_of(command);
    const CapturedHit& hit = capture.hits.at(0);
    if (node.empty()) node = hit.results.at(0).node;
    const int material = scene.triangles.at(size_t(hit.hit.triangle)).material;
    const DebugStop stop = find_stop_in(scene, node, material, command.line);
    const std::vector<std::string> program = replay_program(command);
    if (command.is_vscode)
        write_launch_file(launch_configuration(command, stop, program));
    else
        become(debugger_command(command.debugger, stop, program, command.commands));
    return 0;
}

}  // namespace

DebugStop find_stop(SceneData& scene, const std::string& asked, int x, int y, int line)
{
    const SceneTextures& textures = scene.textures;
    const std::string node = node_in_use(scene, asked);
    scene.settings.at(0).max_bounces = 0;
    const int material = material_at(scene, x, y);
    if (material < 0)
        throw std::runtime_error(fmt::format("--pixel {},{}: shows no surface; {} is on: {}", x, y,
                                             node, materials_of(scene, node)));
    const auto at = std::ranges::find_if(textures.attachments, [&](const auto& attachment) {
        return attachment.node == node && attachment.material == material;
    });
    if (at == textures.attachments.end())
        throw std::runtime_error(fmt::format(
            "--pixel {},{}: shows material {}, whose texture nodes are: {}; {} is on: {}", x, y,
            scene.material_names.at(size_t(material)), node_names(scene, material), node,
            materials_of(scene, node)));
    return find_stop_in(scene, node, material, line);
}

DebugStop find_stop_in(const SceneData& scene, const std::string& node, int material, int line)
{
    const SceneTextures& textures = scene.textures;
    const auto at = std::ranges::find_if(textures.attachments, [&](const auto& attachment) {
        return attachment.node == node && attachment.material == material;
    });
    if (at == textures.attachments.end())
        throw std::runtime_error(fmt::format("--texture {}: no such node on material {}; it has {}",
                                             node, scene.material_names.at(size_t(material)),
                                             node_names(scene, material)));
    const TextureFunction& function = textures.functions.at(size_t(at->function));
    if (const int lines = lines_of(function.file); line < 0 || line > lines)
        throw std::runtime_error(
            fmt::format("--line {}: {} has {} lines", line, function.file, lines));
    const std::string space = "user_language::" + function.id + "::";
    const auto calls = std::ranges::count_if(textures.attachments, [&](const auto& attachment) {
        return attachment.function == at->function && attachment.material == material;
    });
    return {space + function.id + "_entry", space + function.entry, function.file, line,
            calls > 1 ? at->first_word : -1};
}

// Names of functions that `step` passes over: all but those of textures, which are in a namespace
// of the file within user_language.
static constexpr const char* not_of_users = "^(user_language::)?[A-Za-z0-9_]+([<(].*)?$";

std::vector<std::string> debugger_command(const std::string& debugger, const DebugStop& stop,
                                          const std::vector<std::string>& program,
                                          const std::vector<std::string>& commands)
{
    const bool is_lldb = debugger == "lldb";
    std::vector<std::string> words = {debugger};
    const auto add = [&](const std::string& command) {
        words.insert(words.end(), {is_lldb ? "-o" : "-ex", command});
    };
    const auto stop_here = [&] { add(is_lldb ? lldb_breakpoint(stop) : gdb_breakpoint(stop)); };
    if (!is_lldb) words.insert(words.end(), {"-q", "-iex", "set debuginfod enabled off"});
    if (!commands.empty()) words.push_back(is_lldb ? "--batch" : "-batch");
    if (!is_lldb) {
        add("set breakpoint pending on");
        add("set print thread-events off");
        add("set print frame-arguments all");
        add(fmt::format("skip -rfu {}", not_of_users));
    } else {
        add(fmt::format("settings set target.process.thread.step-avoid-regexp {}", not_of_users));
    }
    if (stop.region < 0) {
        stop_here();
        add("run");
    } else {  // first to where the function is called for this node
        add(is_lldb ? fmt::format("breakpoint set --one-shot true --name {} --condition "
                                  "'region == {}'",
                                  stop.entry, stop.region)
                    : fmt::format("tbreak {} if region == {}", stop.entry, stop.region));
        add("run");
        stop_here();
        add("continue");
    }
    for (const std::string& command : commands) add(command);
    words.push_back(is_lldb ? "--" : "--args");
    words.insert(words.end(), program.begin(), program.end());
    return words;
}

CLI::App* add_debug_command(CLI::App& app, DebugCommand& command)
{
    CLI::App* debug = app.add_subcommand(
        "debug", "Stop in a procedural texture, in its own file, where a pixel is evaluated");
    command.device.backend = "twin";
    command.scene.samples = 1;
    add_scene_flags(*debug, command.scene);
    add_device_flags(*debug, command.device);
    debug->add_option("--pixel", command.pixel, "The pixel to evaluate, X,Y from the upper left");
    debug->add_option(
        "--line", command.line,
        "Line of the texture's file to stop at; without it, where its function begins");
    debug->add_option("--debugger", command.debugger, "gdb or lldb")->capture_default_str();
    debug
        ->add_option("--execute", command.commands,
                     "A command for the debugger once it has stopped there; it ends after the last")
        ->allow_extra_args(false);
    debug->add_option(
        "--replay", command.replay,
        "Run the hits of a file that render --capture wrote, instead of a pixel; the "
        "scene's name may be left out. With --print no debugger starts: what the host "
        "computes is printed beside what the device gave");
    debug->add_flag("--print", command.is_print,
                    "Print the debugger's command instead of running it");
    debug->add_flag("--vscode", command.is_vscode,
                    "Write the same as a configuration into .vscode/launch.json instead");
    debug->footer(
        "--texture NODE says where to stop; with a \"=\" in it, it is what it is for "
        "render. Compiled without\noptimisation, a texture gives the same bits.\n"
        "Exit codes: the debugger's; --replay --print: 0 the device's bits, 1 others; 2 error.");
    return debug;
}

int run_debug_command(const DebugCommand& command)
{
    check(command);
    SceneFlags flags = command.scene;
    std::erase_if(flags.load.textures,
                  [](const std::string& text) { return text.find('=') == std::string::npos; });
    if (!command.replay.empty()) return replay(command, std::move(flags));
    const std::optional<Pixel> pixel = parse_pixel(command.pixel, flags.size);
    SceneData scene = load_from_flags(flags);
    print_generated_notices(scene, command.device);
    const DebugStop stop = find_stop(scene, node_of(command), pixel->x, pixel->y, command.line);
    const std::vector<std::string> program = program_of(command);
    if (command.is_vscode) {
        write_launch_file(launch_configuration(command, stop, program));
        return 0;
    }
    const std::vector<std::string> words =
        debugger_command(command.debugger, stop, program, command.commands);
    if (!command.is_print) become(words);
    std::string line;
    for (const std::string& word : words) line += (line.empty() ? "" : " ") + quoted(word);
    fmt::print("{}\n", line);
    return 0;
}

}  // namespace diptych
