#include "host/commands/watch_command.hpp"

#include "host/commands/picture_flags.hpp"
#include "host/commands/render_report.hpp"
#include "host/live/file_watcher.hpp"
#include "host/live/line_reader.hpp"
#include "host/live/live_render.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <stdexcept>
#include <unistd.h>

namespace diptych {
namespace {

// Between the terminal, the files and the render.
class WatchSession {
public:
    WatchSession(const RenderCommand& command, const RenderOptions& aims,
                 const image::WriteOptions& write)
        : command_(command), aims_(aims), write_(write), interrupted_(watch_for_interrupts())
    {
    }

    LiveHooks hooks()
    {
        return {.requests = [this](double seconds) { return requests(seconds); },
                .watch_files = [this](const auto& files,
                                      auto read_at) { watcher_.watch(files, read_at); },
                .show =
                    [this](const image::Picture& picture, const LiveScene& scene, const Backend&,
                           const RenderResult* end) {
                        if (show(picture) && end) tell_end(*end, scene);
                    },
                .notices =
                    [this](const SceneData& scene) {
                        return generated_notices(scene, command_.device);
                    },
                .tell = [this](const std::string& line) { tell(line); },
                .warn =
                    [](const std::string& message) {
                        fmt::print(stderr, "{}\nwatch: not taken; the picture goes on as it was\n",
                                   message);
                    }};
    }

    void tell(const std::string& line) const
    {
        if (!command_.is_quiet) fmt::print(stderr, "watch: {}\n", line);
    }
    bool is_interrupted() const { return interrupted_; }

private:
    Requests requests(double wait_seconds)
    {
        if (wait_seconds > 0 && !interrupted_) watcher_.wait(wait_seconds, input_.descriptor());
        Requests requests;
        requests.since = FileWatcher::Clock::now();
        requests.changed = watcher_.changed();
        if (!requests.changed.empty()) requests.since = watcher_.noticed();
        for (std::string& line : input_.lines()) {
            if (line == "quit" || line == "exit")
                requests.is_over = true;
            else
                requests.values.push_back(std::move(line));
        }
        requests.is_over |= interrupted_.load();
        return requests;
    }

    // A disk that is full now may not be in a minute.
    bool show(image::Picture picture) const
    {
        picture.metadata["program"] = "diptych " DIPTYCH_VERSION;
        picture.metadata["backend"] = command_.device.backend;
        if (!command_.is_reproducible) picture.metadata["command_line"] = command_.command_line;
        try {
            image::write_pictures(command_.outputs, picture, write_);
        } catch (const std::runtime_error& error) {
            fmt::print(stderr, "{}\n", error.what());
            return false;
        }
        return true;
    }

    void tell_end(const RenderResult& end, const LiveScene& scene) const
    {
        if (is_adaptive(aims_)) {
            const ErrorSummary error =
                summarise_error(end.film, error_grid(scene.data().settings[0]), aims_.viewer,
                                aims_.error > 0 ? aims_.error : 1);
            tell(ending_text(end, aims_, error));
            tell("complete, written; waiting for edits");
        } else {
            tell(fmt::format("complete with {} samples a pixel, written; waiting for edits",
                             aims_.samples));
        }
    }

    const RenderCommand& command_;
    const RenderOptions& aims_;
    const image::WriteOptions& write_;
    const std::atomic<bool>& interrupted_;
    FileWatcher watcher_;
    LineReader input_{STDIN_FILENO};
};

std::vector<std::filesystem::path> other_files(const SceneFlags& flags)
{
    const std::string& picture = flags.load.environment;
    if (picture.empty() || picture == "none") return {};
    return {picture};
}

}  // namespace

CLI::App* add_watch_command(CLI::App& app, WatchCommand& command)
{
    CLI::App* watch = app.add_subcommand(
        "watch", "Render a scene, and go on while its files and textures are edited");
    add_scene_flags(*watch, command.render.scene);
    watch->get_option("SCENE")->required()->description("glTF 2.0 file (.gltf or .glb)");
    add_output_flags(*watch, command.render);
    add_device_flags(*watch, command.render.device);
    add_error_flags(*watch, command.render.error);
    watch->footer(
        "The pictures are written anew as samples come, and hold --samples in the end, or what "
        "--error "
        "and --time ask\nfor; an edit begins the time again. Saving a texture's file makes its "
        "stage anew; changing arguments in the scene's file, or typing "
        "NODE.ARGUMENT=JSON, compiles\nnothing; any other change loads the scene again. An edit "
        "that fails is told and not taken.\n"
        "`quit` or SIGINT end it with the picture as it is.\n"
        "Exit codes: 0 quit, 2 error before the first picture, 130 interrupted (pictures "
        "written).");
    return watch;
}

int run_watch_command(const WatchCommand& command)
{
    RenderCommand run = command.render;
    run.device = with_device_list(run.device);
    if (run.outputs.empty()) run.outputs.push_back("diptych.png");
    const image::WriteOptions write = picture_options(run.view, run.write, run.outputs);
    for (const std::string& path : run.outputs) image::check_writable(path);

    RenderOptions aims;
    aims.viewer = {write.exposure, write.view};
    set_targets(run.error, run.scene.samples, aims);

    WatchSession session(run, aims, write);
    const auto load = [&](const std::vector<std::string>& typed) {
        SceneFlags flags = run.scene;
        flags.load.typed_values = typed;
        return load_from_flags(flags, is_adaptive(aims));
    };
    LiveScene scene(run.scene.scene, other_files(run.scene), run.scene.load.texture_values, load);
    const auto make = [&] {
        return make_backend(run.device.backend, options_from_flags(run.device));
    };
    LiveRender live(scene, make, session.hooks(), aims);
    if (!run.is_quiet)
        print_plan(scene.data(), live.backend(), live.backend().plan(scene.data()), aims);
    session.tell(
        fmt::format("{} files; NODE.ARGUMENT=JSON sets a value, quit ends", scene.files().size()));
    live.run();
    return session.is_interrupted() ? 130 : 0;
}

}  // namespace diptych
