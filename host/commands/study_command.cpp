#include "host/commands/study_command.hpp"

#include "host/commands/study_devices.hpp"
#include "host/commands/study_measurement.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <cstdio>
#include <stdexcept>
#include <utility>

namespace diptych {
namespace {

constexpr int exit_different = 1;

constexpr TextureArm ours{};
constexpr TextureArm pasted{.pastes_arguments = true};
constexpr TextureArm traced_inside{.traces_inside = true};
constexpr TextureArm all_inline{.pastes_arguments = true, .traces_inside = true};

// Places in rows_of_study().
enum Row {
    PLAIN,
    OPEN_RUST,
    OPEN_RUST_PASTED,
    RUST,
    RUST_PASTED,
    RUST_TRACED,
    RUST_INLINE,
    SCRATCHES,
    SCRATCHES_PASTED
};

const std::vector<StudyRow>& rows_of_study()
{
    static const std::vector<StudyRow> rows = {
        {"plain diffuse", HelmetMaterial::plain},
        {"rust without occlusion, interpreter", HelmetMaterial::open_rust, ours},
        {"rust without occlusion, inlined constants", HelmetMaterial::open_rust, pasted},
        {"rust, interpreter, occlusion as stage", HelmetMaterial::rust, ours},
        {"rust, inlined constants, occlusion as stage", HelmetMaterial::rust, pasted},
        {"rust, interpreter, occlusion inline", HelmetMaterial::rust, traced_inside},
        {"rust, inlined constants, occlusion inline", HelmetMaterial::rust, all_inline},
        {"scratches, interpreter", HelmetMaterial::scratches, ours},
        {"scratches, inlined constants", HelmetMaterial::scratches, pasted},
    };
    return rows;
}

double increase(const BackendTimes& times, Row row)
{
    return 100 * (times.rows[row].seconds / times.rows[PLAIN].seconds - 1);
}

// Of the whole, as percent of the plain row's time: what a stage took, in the share that it has of
// its row's stages.
double stage_increase(const BackendTimes& times, Row row, double seconds)
{
    const RowTimes& own = times.rows[row];
    return own.stage_seconds > 0
               ? 100 * own.seconds / times.rows[PLAIN].seconds * seconds / own.stage_seconds
               : 0;
}

std::string percent(double value) { return fmt::format("{:+.1f} %", value); }

void print_times(const BackendTimes& times)
{
    fmt::print("\n{}\n", times.description);
    fmt::print("  {:<44} {:>11} {:>11} {:>11} {:>11}\n", "", "ns/sample", "over plain",
               "of it rays", "textures");
    for (size_t r = 0; r < times.rows.size(); ++r) {
        const RowTimes& row = times.rows[r];
        const bool is_split = r != PLAIN && !rows_of_study()[r].arm.traces_inside;
        fmt::print("  {:<44} {:>11.1f} {:>11} {:>11} {:>11}\n", rows_of_study()[r].name,
                   row.seconds / times.samples * 1e9,
                   r == PLAIN ? "" : percent(increase(times, Row(r))),
                   is_split && row.ray_seconds > 0
                       ? percent(stage_increase(times, Row(r), row.ray_seconds))
                       : "",
                   r == PLAIN ? "" : percent(stage_increase(times, Row(r), row.texture_seconds)));
        std::fflush(stdout);
    }
}

// "holds" or "FAILED", with what was compared.
void print_sign(const std::string& what, bool holds, const std::string& numbers)
{
    fmt::print("  {:<7} {}: {}\n", holds ? "holds" : "FAILED", what, numbers);
}

std::string two(const BackendTimes& times, Row a, Row b)
{
    return percent(increase(times, a)) + " against " + percent(increase(times, b));
}

void print_signs(const BackendTimes& times)
{
    const auto seconds = [&](Row row) { return times.rows[row].seconds; };
    print_sign("rust, interpreter and stage faster than all inlined (paper: +21 % against +46 %)",
               seconds(RUST) < seconds(RUST_INLINE), two(times, RUST, RUST_INLINE));
    print_sign("occlusion as a stage faster than inline", seconds(RUST) < seconds(RUST_TRACED),
               two(times, RUST, RUST_TRACED));
    print_sign("scratches, interpreter slower than inlined (paper: +15 % against +9 %)",
               seconds(SCRATCHES) > seconds(SCRATCHES_PASTED),
               two(times, SCRATCHES, SCRATCHES_PASTED));
    print_sign("goal: rust below Cycles' +32 % (Cycles 5.2, the same scene)",
               increase(times, RUST) < 32, percent(increase(times, RUST)));
    print_sign("goal: rust at most the paper's +21 %", increase(times, RUST) <= 21,
               percent(increase(times, RUST)));
    print_sign("goal: texture code of rust at most +4 %", increase(times, OPEN_RUST) <= 4,
               percent(increase(times, OPEN_RUST)) + " without occlusion");
    print_sign("goal: texture code of scratches at most +4 %", increase(times, SCRATCHES) <= 4,
               percent(increase(times, SCRATCHES)));
}

bool are_the_same(const BackendTimes& times)
{
    bool all = true;
    for (size_t r = 0; r < times.rows.size(); ++r) {
        if (times.rows[r].differing == 0) continue;
        all = false;
        fmt::print("  FAILED  {}: {} results differ from the first arm's\n",
                   rows_of_study()[r].name, times.rows[r].differing);
    }
    if (all) fmt::print("  holds   all arms of a row give the same picture, bit for bit\n");
    return all;
}

std::vector<std::string> names_in(const std::string& list)
{
    std::vector<std::string> names;
    for (size_t at = 0; at < list.size();) {
        const size_t end = std::min(list.find(',', at), list.size());
        names.push_back(list.substr(at, end - at));
        at = end + 1;
    }
    return names;
}

// Rows whose pictures are written, and what their files are called.
constexpr std::pair<Row, const char*> pictured_rows[] = {
    {PLAIN, "plain"}, {RUST, "rust"}, {SCRATCHES, "scratches"}};

std::string picture_file(const StudyCommand& command, const char* row, const std::string& backend)
{
    return fmt::format("{}-{}-{}.png", command.output, row, backend);
}

void check(const StudyCommand& command)
{
    const auto refuse = [](const std::string& flag, int value, int low, int high) {
        if (value < low || value > high)
            throw std::runtime_error(
                fmt::format("{} {}: out of range; give {} to {}", flag, value, low, high));
    };
    refuse("--size", command.study.side, 16, 4096);
    refuse("--samples", command.study.samples, 1, 65536);
    refuse("--rays", command.study.rays, 1, 256);
    refuse("--repeat", command.repetitions, 1, 100);
    if (command.output.empty()) return;
    for (const std::string& name : names_in(command.backends))
        for (const auto& [row, text] : pictured_rows)
            image::check_writable(picture_file(command, text, name));
}

}  // namespace

CLI::App* add_study_command(CLI::App& app, StudyCommand& command)
{
    CLI::App* study = app.add_subcommand("study", "Repeat an experiment on this machine");
    study->require_subcommand(1);
    CLI::App* textures = study->add_subcommand(
        "textures", "Table 1 of the paper on restricted textures: what rust and scratches cost");
    textures->add_option("--scenes", command.scenes,
                         "Folder with gi-lux-kitchen and bevy-FlightHelmet-512; default: scenes "
                         "in DIPTYCH_SHARED");
    textures->add_option("--size", command.study.side, "Pixels of the picture's sides")
        ->capture_default_str();
    textures->add_option("--samples", command.study.samples, "Samples a pixel")
        ->capture_default_str();
    textures->add_option("--rays", command.study.rays, "Occlusion rays of a request")
        ->capture_default_str();
    textures
        ->add_option("--repeat", command.repetitions,
                     "Render everything so often; the least time of each part counts")
        ->capture_default_str();
    textures->add_option("--backends", command.backends, "Those to measure; empty: none")
        ->capture_default_str();
    textures->add_flag("--no-devices", command.is_without_devices,
                       "Leave out registers, stack and code on GPUs");
    textures->add_option("-o,--output", command.output,
                         "Also write the pictures, under names that begin so");
    add_device_options(*textures, command.device);
    textures->footer("Exit codes: 0 measured, 1 pictures of two arms differ, 2 error.");
    study->footer("Exit codes: 0 measured, 1 pictures of two arms differ, 2 error.");
    return study;
}

int run_study_command(const StudyCommand& command)
{
    check(command);
    StudyOptions study = command.study;
    study.scenes =
        command.scenes.empty() ? default_study_scenes() : std::filesystem::path(command.scenes);
    const StudyScenes scenes(study);
    fmt::print("Table 1 of \"Restricted Extensions for GPU Photo-realistic Renderer\": a helmet in "
               "a kitchen, {0}x{0}, {1} samples, {2} occlusion rays a request.\n",
               study.side, study.samples, study.rays);
    fmt::print("Rows take turns within one process; `rays` and `textures` are the stages' shares "
               "as percent of the plain row.\n");
    bool is_same = true;
    for (const std::string& name : names_in(command.backends)) {
        const BackendTimes times = measure_rows(name, options_from_flags(command.device), scenes,
                                                study, rows_of_study(), command.repetitions);
        print_times(times);
        is_same &= are_the_same(times);
        print_signs(times);
        if (command.output.empty()) continue;
        for (const auto& [row, text] : pictured_rows)
            image::write_picture(picture_file(command, text, name), times.pictures[row]);
    }
    if (!command.is_without_devices) print_study_devices(scenes);
    return is_same ? 0 : exit_different;
}

}  // namespace diptych
