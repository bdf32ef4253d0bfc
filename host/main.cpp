// The command line: each command is a file in host/commands.
#include "host/commands/compare_backends.hpp"
#include "host/commands/debug_command.hpp"
#include "host/commands/devices_command.hpp"
#include "host/commands/explain_command.hpp"
#include "host/commands/farm_command.hpp"
#include "host/commands/merge_command.hpp"
#include "host/commands/render_command.hpp"
#include "host/commands/selftest_command.hpp"
#include "host/commands/study_command.hpp"
#include "host/commands/texture_command.hpp"
#include "host/commands/watch_command.hpp"
#include "host/image/compare_cli.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <iostream>
#include <new>

namespace {

constexpr int exit_error = 2;

std::string joined(int count, char** arguments)
{
    std::string text = "diptych";
    for (int k = 1; k < count; ++k) text += std::string(" ") + arguments[k];
    return text;
}

// One line, whatever the parser says.
int refuse(const CLI::App& app, const CLI::ParseError& error, const std::string& first)
{
    std::string text = error.what();
    std::replace(text.begin(), text.end(), '\n', ' ');
    const std::vector<CLI::App*> parsed = app.get_subcommands();
    if (parsed.empty() && !first.empty() && first[0] != '-') text = first + ": no such command";
    const std::string command = parsed.empty() ? "" : parsed.front()->get_name() + " ";
    const std::string at = parsed.empty() ? "" : parsed.front()->get_name() + ": ";
    fmt::print(stderr, "diptych: {}{}; see diptych {}--help\n", at, text, command);
    return exit_error;
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
    MergeCommand merge;
    const CLI::App* merge_command = add_merge_command(app, merge);
    FarmCommand farm;
    const CLI::App* farm_command = add_farm_command(app, farm);
    WatchCommand watch;
    watch.render.command_line = render.command_line;
    const CLI::App* watch_command = add_watch_command(app, watch);
    CompareBackendsCommand compare;
    CLI::App* compare_command = image::add_compare_command(app, compare.compare);
    add_compare_backends_flags(*compare_command, compare);
    ExplainCommand explain;
    const CLI::App* explain_command = add_explain_command(app, explain);
    const CLI::App* devices_command = add_devices_command(app);
    SelftestCommand selftest;
    const CLI::App* selftest_command = add_selftest_command(app, selftest);
    TextureCommand texture;
    const CLI::App* texture_command = add_texture_command(app, texture);
    StudyCommand study;
    const CLI::App* study_command = add_study_command(app, study);
    DebugCommand debug;
    debug.words.assign(arguments, arguments + count);
    const CLI::App* debug_command = add_debug_command(app, debug);
    try {
        app.parse(count, arguments);
    } catch (const CLI::ParseError& error) {
        return error.get_exit_code() == 0 ? app.exit(error)
                                          : refuse(app, error, count > 1 ? arguments[1] : "");
    }
    if (render_command->parsed()) return run_render_command(render);
    if (merge_command->parsed()) return run_merge_command(merge);
    if (farm_command->parsed()) return run_farm_command(farm);
    if (watch_command->parsed()) return run_watch_command(watch);
    if (explain_command->parsed()) return run_explain_command(explain);
    if (devices_command->parsed()) return run_devices_command();
    if (selftest_command->parsed()) return run_selftest_command(selftest);
    if (texture_command->parsed()) return run_texture_command(*texture_command, texture);
    if (study_command->parsed()) return run_study_command(study);
    if (debug_command->parsed()) return run_debug_command(debug);
    if (compare_command->parsed() && !compare.compare.backends.empty())
        return run_compare_backends(compare, std::cout);
    if (compare_command->parsed())
        return image::compare_command(compare.compare, std::cout, std::cerr);
    return exit_error;
}

// What was printed has arrived, or the exit code says so.
int finished(int code)
{
    std::cout.flush();
    if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0 && std::cout.good()) return code;
    fmt::print(stderr, "diptych: standard output: cannot be written; is the disk full?\n");
    return exit_error;
}

}  // namespace

int main(int count, char** arguments)
{
    try {
        return finished(run(count, arguments));
    } catch (const std::bad_alloc&) {
        fmt::print(stderr, "diptych: out of memory; render a smaller picture or scene\n");
        return exit_error;
    } catch (const std::exception& error) {
        fmt::print(stderr, "diptych: {}\n", error.what());
        return exit_error;
    }
}
