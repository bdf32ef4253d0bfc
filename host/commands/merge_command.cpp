#include "host/commands/merge_command.hpp"

#include "host/commands/picture_flags.hpp"
#include "host/commands/progress_pictures.hpp"
#include "host/render/checkpoint_merge.hpp"
#include "host/render/safe_file.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <filesystem>
#include <optional>
#include <stdexcept>

namespace diptych {
namespace {

std::string samples_of(const std::vector<Slice>& slices)
{
    std::string text;
    for (const Slice& slice : slices)
        text += fmt::format("{}{}..{}{}", text.empty() ? "samples " : ", ", slice.first, slice.end,
                            is_complete(slice) ? "" : " (not all yet)");
    return text;
}

std::string description(const Checkpoint& checkpoint)
{
    return fmt::format("{}, by {}", samples_of(checkpoint.head.slices),
                       fmt::join(checkpoint.head.backends, ", "));
}

void tell_gap(int first, int end)
{
    if (first < end)
        fmt::print(stderr, "notice: samples {}..{} are in none of the files\n", first, end);
}

void tell_what_is_missing(const CheckpointHead& head)
{
    int end = 0;
    for (const Slice& slice : head.slices) {
        tell_gap(end, slice.first);
        if (!is_complete(slice))
            fmt::print(stderr, "notice: samples {}..{} are not all rendered yet\n", slice.first,
                       slice.end);
        end = slice.end;
    }
    tell_gap(end, head.planned);
}

image::Picture picture_of(const Checkpoint& checkpoint, const image::Viewer& viewer)
{
    image::Picture picture = picture_of(checkpoint.film, viewer);
    picture.metadata["program"] = checkpoint.head.subject.program;
    picture.metadata["scene_sha256"] = checkpoint.head.subject.scene;
    picture.metadata["backend"] = fmt::format("{}", fmt::join(checkpoint.head.backends, ", "));
    picture.metadata["samples"] = samples_of(checkpoint.head.slices).substr(8);
    return picture;
}

Checkpoint read_merged(const MergeCommand& command)
{
    std::optional<Checkpoint> all;
    std::vector<CheckpointHead> heads;
    for (const std::string& name : command.inputs) {
        Checkpoint more = read_checkpoint(name);
        if (!command.is_quiet) fmt::print(stderr, "{}: {}\n", name, description(more));
        for (size_t k = 0; k < heads.size(); ++k)
            expect_mergeable(heads[k], command.inputs[k], more.head, name);
        heads.push_back(more.head);
        if (all)
            add_checkpoint(*all, more);
        else
            all = std::move(more);
    }
    return std::move(*all);
}

// A checkpoint would be taken for a picture by its name.
void expect_known_format(const std::string& output)
{
    if (image::is_foreign_picture_name(output)) image::check_writable(output);  // tells the formats
}

// A slice that is overwritten can no longer be gone on with.
void expect_no_input(const std::string& output, const std::vector<std::string>& inputs)
{
    for (const std::string& input : inputs) {
        std::error_code ignored;
        if (std::filesystem::equivalent(input, output, ignored))
            throw std::runtime_error(output + ": is one of the checkpoints to merge, which would "
                                              "be lost; name another file by -o");
    }
}

void write_as_checkpoint(const std::string& path, const Checkpoint& checkpoint)
{
    const FileLock lock(path);
    SafeFile file(path);
    write_checkpoint(file, checkpoint.head, checkpoint.film);
    file.put_in_place();
}

void write_all(const MergeCommand& command, const Checkpoint& all, const image::WriteOptions& write)
{
    std::optional<image::Picture> picture;
    image::write_each(command.outputs, [&](const std::string& path) {
        if (!image::is_picture_name(path)) {
            write_as_checkpoint(path, all);
        } else {
            if (!picture) picture = picture_of(all, {write.exposure, write.view});
            image::write_picture(path, *picture, write);
        }
        if (!command.is_quiet) fmt::print(stderr, "wrote {}\n", path);
    });
}

}  // namespace

CLI::App* add_merge_command(CLI::App& app, MergeCommand& command)
{
    CLI::App* merge =
        app.add_subcommand("merge", "Put the checkpoints of a picture's slices together");
    merge
        ->add_option("CHECKPOINT", command.inputs,
                     "Checkpoints by `diptych render --checkpoint`, of different --range of one "
                     "picture, on whatever backends")
        ->required();
    merge
        ->add_option("-o,--output", command.outputs,
                     "Picture to write, as of diptych render; any other name is written as a "
                     "checkpoint. May be given more than once")
        ->allow_extra_args(false)
        ->required();
    add_picture_flags(*merge, command.view, command.write);
    merge->add_flag("--quiet", command.is_quiet, "Print errors only");
    merge->footer("Exit codes: 0 written, 2 error.");
    return merge;
}

int run_merge_command(const MergeCommand& command)
{
    const image::WriteOptions write = picture_options(command.view, command.write, command.outputs);
    for (const std::string& path : command.outputs) {
        expect_no_input(path, command.inputs);
        expect_known_format(path);
        image::check_file_writable(path);
    }

    const Checkpoint all = read_merged(command);
    if (!command.is_quiet) {
        fmt::print(stderr, "together: {}\n", description(all));
        tell_what_is_missing(all.head);
    }
    write_all(command, all, write);
    return 0;
}

}  // namespace diptych
