#include "host/commands/texture_command.hpp"

#include "backends/textures/texture_tool.hpp"
#include "host/commands/texture_cost.hpp"
#include "host/commands/texture_fault_report.hpp"
#include "host/commands/texture_memory.hpp"
#include "host/commands/texture_preview.hpp"
#include "host/render/render.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <iostream>
#include <iterator>
#include <stdexcept>

namespace diptych {
namespace {

using nlohmann::json;

constexpr int exit_refused = 2;

void add_file(CLI::App& command, TextureCommand& options)
{
    command
        .add_option("FILE", options.file,
                    "C file of a texture, with :FUNCTION if need be, or a texture of the library")
        ->required();
}

void add_values(CLI::App& command, TextureCommand& options)
{
    command
        .add_option("--set", options.values,
                    "A value for an argument, ARGUMENT=JSON; for an image the name of its file")
        ->allow_extra_args(false);
}

std::string signature(const TextureFunction& function)
{
    std::vector<std::string> arguments;
    for (const TextureArgument& argument : function.arguments)
        arguments.push_back(type_of(argument) + " " + argument.name);
    return fmt::format("{} {}({})", json::parse(function.description).value("result", "float4"),
                       function.entry, fmt::join(arguments, ", "));
}

// The tool's findings as it gives them, one a line, for editors that read compilers' messages.
int check(const TextureCommand& command)
{
    const TextureFile file = find_texture_file(command.file);
    TextureFunction function;
    try {
        function = translate_texture({file.path, file.name, file.entry, "t0"});
    } catch (const std::runtime_error& error) {
        std::cerr << error.what() << "\n";
        return exit_refused;
    }
    for (const std::string& warning : function.warnings) std::cerr << warning << "\n";
    fmt::print("{}: good: {}\n", file.name, signature(function));
    return 0;
}

std::string listed(const json& names)
{
    const auto all = names.get<std::vector<std::string>>();
    return all.empty() ? "none" : fmt::format("{}", fmt::join(all, ", "));
}

std::string distance_of(const OcclusionRequest& request, const TextureFunction& function)
{
    if (request.distance_argument >= 0)
        return "up to argument " + function.arguments.at(size_t(request.distance_argument)).name;
    return request.distance > 0 ? fmt::format("up to {} m", request.distance)
                                : "up to the scene's default";
}

void show_occlusion(const TextureFunction& function)
{
    static constexpr const char* hemispheres[] = {"above", "below", "on both sides"};
    if (function.occlusion.empty()) fmt::print("occlusion   none\n");
    for (const OcclusionRequest& request : function.occlusion)
        fmt::print("occlusion   {} the surface, {}{}\n", hemispheres[int(request.hemisphere)],
                   distance_of(request, function),
                   request.is_same_object ? ", by the same object alone" : "");
}

void show_arguments(const TextureFunction& function)
{
    if (function.arguments.empty()) fmt::print("arguments   none\n");
    for (size_t k = 0; k < function.arguments.size(); ++k) {
        const TextureArgument& argument = function.arguments[k];
        std::string text = fmt::format("{:<12}{:<9} {:<12}", k == 0 ? "arguments" : "",
                                       type_of(argument), argument.name);
        if (!argument.default_value.empty())
            text += fmt::format(" default {};", argument.default_value);
        text += " " + argument.about;
        text.erase(text.find_last_not_of(' ') + 1);
        fmt::print("{}\n", text);
    }
}

int show(const TextureCommand& command)
{
    const TextureFile file = find_texture_file(command.file);
    const TextureFunction function =
        translate_texture({file.path, file.name, file.entry, "texture"});
    if (command.code == "opencl" || command.code == "c++") {
        std::cout << (command.code == "c++" ? function.cpp : function.opencl);
        return 0;
    }
    if (!command.code.empty())
        throw std::runtime_error("--code " + command.code + ": no such variant; opencl or c++");
    const json about = json::parse(function.description);
    fmt::print("{}:{}: {}\n", file.name, about.value("line", 1), signature(function));
    show_arguments(function);
    fmt::print("attributes  {}\n", listed(about.at("attributes")));
    fmt::print("settings    {}\n", listed(about.at("settings")));
    show_occlusion(function);
    fmt::print("images      {}\n", about.value("images", false) ? "read" : "none");
    fmt::print("changed     {} of {} lines, for the devices\n", about.value("changed_lines", 0),
               about.value("total_lines", 0));
    for (const std::string& warning : function.warnings) fmt::print("{}\n", warning);
    return 0;
}

int preview(const TextureCommand& command)
{
    const auto [width, height] = parse_size(command.size);
    if (command.samples < 1 || command.samples > 65536)
        throw std::runtime_error(
            fmt::format("--samples {}: out of range; give 1 to 65536", command.samples));
    image::check_writable(command.output);
    SceneData scene = preview_scene(find_texture_file(command.file),
                                    {command.values, command.slot, width, height});
    std::ranges::move(generated_notices(scene, command.device), std::back_inserter(scene.notices));
    for (const std::string& notice : scene.notices) fmt::print(stderr, "notice: {}\n", notice);
    const std::unique_ptr<Backend> backend =
        make_backend(command.device.backend, options_from_flags(command.device));
    backend->upload(scene);
    RenderOptions options;
    options.samples = command.samples;
    const RenderResult result = render(*backend, scene, options);
    if (result.film.faults().count > 0)
        fmt::print(stderr, "notice: {} samples were not finite and were dropped\n",
                   result.film.faults().count);
    const TextureFaultReport faults =
        find_texture_faults(*backend, command.device.backend, scene, result.film.texture_faults());
    for (int kind = 0; kind < TEXTURE_FAULT_COUNT; ++kind)
        if (faults.faults.of_kind[size_t(kind)].count > 0)
            fmt::print(stderr, "notice: {}\n", texture_fault_text(faults, kind));
    image::write_picture(command.output, result.film.picture());
    fmt::print("wrote {}\n", command.output);
    return 0;
}

int cost(const TextureCommand& command)
{
    std::cout << cost_card(find_texture_file(command.file), command.values, command.backends,
                           options_from_flags(command.device));
    return 0;
}

}  // namespace

CLI::App* add_texture_command(CLI::App& app, TextureCommand& command)
{
    CLI::App* texture = app.add_subcommand("texture", "Look at one procedural texture");
    texture->require_subcommand(1);
    texture->footer("Exit codes: 0 done, 2 error or refused texture.");

    CLI::App* check = texture->add_subcommand("check", "Say what is wrong with a texture");
    add_file(*check, command);
    check->footer("Errors and warnings as file:line:column: on standard error.\n"
                  "Exit codes: 0 good, 2 refused.");

    CLI::App* show = texture->add_subcommand("show", "Tell what a texture takes and asks for");
    add_file(*show, command);
    show->add_option("--code", command.code,
                     "Print what the texture becomes for devices instead: opencl or c++");

    CLI::App* preview =
        texture->add_subcommand("preview", "Render a texture on a sphere and a square");
    add_file(*preview, command);
    add_values(*preview, command);
    preview->add_option("-o,--output", command.output, "Picture to write")->capture_default_str();
    preview->add_option("--slot", command.slot, "What of the material the texture gives")
        ->capture_default_str();
    preview->add_option("--size", command.size, "Picture size, WxH in pixels")
        ->capture_default_str();
    preview->add_option("--samples", command.samples, "Samples a pixel")->capture_default_str();
    add_device_flags(*preview, command.device);

    CLI::App* memory = texture->add_subcommand(
        "memory", "Show where a scene's materials keep the programs and arguments of textures");
    add_scene_flags(*memory, command.scene);
    memory->add_option("--json", command.json, "Write the same as JSON; - is standard output");

    CLI::App* cost = texture->add_subcommand(
        "cost", "Measure an evaluation on every backend, and what compilers for GPUs say of it");
    add_file(*cost, command);
    add_values(*cost, command);
    cost->add_option("--backends", command.backends,
                     "Those to measure, as cpu,opencl; default: all that work");
    add_device_options(*cost, command.device);
    return texture;
}

int run_texture_command(const CLI::App& texture, const TextureCommand& command)
{
    const std::string name = texture.get_subcommands().front()->get_name();
    if (name == "check") return check(command);
    if (name == "show") return show(command);
    if (name == "preview") return preview(command);
    if (name == "memory") return show_texture_memory(command.scene, command.json);
    return cost(command);
}

}  // namespace diptych
