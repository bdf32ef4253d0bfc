#include "host/commands/farm_check.hpp"

#include "host/commands/picture_flags.hpp"
#include "host/commands/render_command.hpp"
#include "host/commands/slurm.hpp"
#include "host/render/checkpoint_merge.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <stdexcept>

namespace diptych {
namespace {

// What a task is told, read as it will read it.
struct Task {
    explicit Task(const FarmCommand& command)
    {
        add_render_command(app, render);
        std::vector<std::string> words = {"render"};
        words.insert(words.end(), command.render.begin(), command.render.end());
        std::reverse(words.begin(), words.end());
        try {
            app.parse(words);
        } catch (const CLI::ParseError& error) {
            throw std::runtime_error(
                fmt::format("farm: {}; see diptych render --help", error.what()));
        }
        render.scene.samples = command.samples;
    }

    CLI::App app;  // render's flags refer to it
    RenderCommand render;
};

void expect_for_slices(const RenderCommand& render)
{
    const CheckpointFlags& flags = render.checkpoint;
    if (!flags.file.empty() || !flags.range.empty() || flags.is_restart || !render.json.empty() ||
        !render.pixel.empty())
        throw std::runtime_error("farm: --checkpoint, --restart, --range, --pixel and --json are "
                                 "the tasks' own; leave them out");
    if (!render.refresh.empty() || !render.preview.empty() || !render.capture.empty())
        throw std::runtime_error("farm: --refresh, --preview and --capture are not for tasks, "
                                 "which have no picture to show; leave them out");
    const ErrorFlags& error = render.error;
    if (error.error_option->count() > 0 || error.share_option->count() > 0 || !error.time.empty() ||
        error.is_unbiased || render.is_audited)
        throw std::runtime_error("farm: --error, --share, --time, --unbiased and --audit are not "
                                 "for slices of the samples; give --samples");
}

// A device is looked for where the tasks run.
void check_device(const DeviceFlags& given)
{
    const DeviceFlags flags = with_device_list(given);
    const BackendOptions options = options_from_flags(flags);
    if (!flags.takes_list && flags.backend != "opencl") make_backend(flags.backend, options);
}

void check_task(const RenderCommand& render)
{
    expect_for_slices(render);
    check_scene_flags(render.scene);
    check_device(render.device);
    if (!render.checkpoint.every.empty()) parse_seconds("--every", render.checkpoint.every);
    if (!render.scene.scene.empty() && !std::filesystem::exists(render.scene.scene))
        throw std::runtime_error(render.scene.scene + ": no such file; name a scene");
}

void check_pictures(const FarmCommand& command, const RenderCommand& render)
{
    picture_options(command.view, command.write, command.outputs);
    for (const std::string& path : command.outputs) image::check_writable(path);
    if (!render.scene.load.aovs.empty() &&
        std::ranges::none_of(command.outputs, image::holds_layers))
        throw std::runtime_error("--aov: pictures with layers are .exr files; name one with -o");
}

// As ci/slurm/render.sbatch divides them.
RenderOptions options_of(const FarmCommand& command, int task)
{
    const auto groups = std::int64_t((command.samples + QUANTUM - 1) / QUANTUM);
    RenderOptions options;
    options.first_sample = int(groups * task / command.tasks) * QUANTUM;
    options.samples = std::min(int(groups * (task + 1) / command.tasks) * QUANTUM, command.samples);
    return options;
}

// The scene is read only where there is something to go on from.
void check_slices(const FarmCommand& command, const RenderCommand& render)
{
    std::optional<CheckpointSubject> subject;
    for (int task = 0; task < command.tasks; ++task) {
        const std::string name = slice_name(command, task);
        std::error_code ignored;
        if (!std::filesystem::exists(name, ignored)) continue;
        try {
            const CheckpointHead head = read_checkpoint_head(name);
            if (!subject)
                subject =
                    checkpoint_subject(load_from_flags(render.scene), "diptych " DIPTYCH_VERSION);
            expect_same_subject(head, name, *subject);
            expect_same_plan(head, name, subject->settings, options_of(command, task));
        } catch (const std::runtime_error& error) {
            throw std::runtime_error("farm: " + with_farms_advice(error.what(), command));
        }
    }
}

}  // namespace

std::string folder_of(const FarmCommand& command)
{
    return command.folder.empty() ? command.outputs.at(0) + ".farm" : command.folder;
}

std::string slice_name(const FarmCommand& command, int task)
{
    return std::filesystem::path(folder_of(command)) / fmt::format("slice-{}.checkpoint", task);
}

std::string with_farms_advice(const std::string& error, const FarmCommand& command)
{
    if (error.find("--restart") == std::string::npos) return error;
    return fmt::format("{}; name another folder with --folder, or delete {} to begin anew",
                       error.substr(0, error.rfind("; ")), folder_of(command));
}

void check_farm(const FarmCommand& command)
{
    const int groups = (command.samples + QUANTUM - 1) / QUANTUM;
    if (command.tasks > groups)
        throw std::runtime_error(
            fmt::format("--tasks {}: --samples {} are {} groups of {}, which are not divided; ask "
                        "for at most {} tasks",
                        command.tasks, command.samples, groups, QUANTUM, groups));
    const Task task(command);
    check_task(task.render);
    check_pictures(command, task.render);
    check_slices(command, task.render);
    expect_slurm();
}

}  // namespace diptych
