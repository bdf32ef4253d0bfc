// The command line: each command is a file in host/commands.
#include "host/commands/render_command.hpp"
#include "host/image/compare_cli.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <iostream>

namespace {

constexpr int exit_error = 2;

std::string joined(int count, char** arguments)
{
    std::string text = "diptych";
    for (int k = 1; k < count; ++k) text += std::string(" ") + arguments[k];
    return text;
}

int run(int count, char** arguments)
{
    using namespace diptych;
    CLI::App app{
        "Diptych: one kernel source, two panels: OpenCL and native C++.\n"
        "Exit codes: 0 done, 1 outside the limits of a comparison, 2 error, 130 interrupted."};
    app.name("diptych");
    app.require_subcommand(1);
    app.set_version_flag("--version", "diptych " DIPTYCH_VERSION);

    RenderCommand render;
    render.command_line = joined(count, arguments);
    const CLI::App* render_command = add_render_command(app, render);
    image::CompareOptions compare;
    const CLI::App* compare_command = image::add_compare_command(app, compare);
    try {
        app.parse(count, arguments);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? 0 : exit_error;
    }
    if (render_command->parsed()) return run_render_command(render);
    if (compare_command->parsed()) return image::compare_command(compare, std::cout, std::cerr);
    return exit_error;
}

}  // namespace

int main(int count, char** arguments)
{
    try {
        return run(count, arguments);
    } catch (const std::exception& error) {
        fmt::print(stderr, "diptych: {}\n", error.what());
        return exit_error;
    }
}
