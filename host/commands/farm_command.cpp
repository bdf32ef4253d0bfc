#include "host/commands/farm_command.hpp"

#include "backends/textures/subprocess.hpp"
#include "host/commands/farm_check.hpp"
#include "host/commands/farm_script.hpp"
#include "host/commands/picture_flags.hpp"
#include "host/commands/render_command.hpp"
#include "host/commands/slurm.hpp"
#include "host/render/checkpoint.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <atomic>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <thread>
#include <unistd.h>

namespace diptych {
namespace {

namespace fs = std::filesystem;

fs::path make_folder(const FarmCommand& command)
{
    const fs::path folder = folder_of(command);
    std::error_code error;
    fs::create_directories(folder, error);
    if (error)
        throw std::runtime_error(
            fmt::format("{}: cannot be made ({}); name a folder that all machines see with "
                        "--folder",
                        folder.string(), error.message()));
    const std::string script = folder / "render.sbatch";
    if (command.script.empty())
        image::write_file_whole(script, farm_script);
    else
        fs::copy_file(command.script, script, fs::copy_options::overwrite_existing, error);
    if (error)
        throw std::runtime_error(fmt::format("--script {}: cannot be copied to {} ({}); name a "
                                             "batch script that can be read",
                                             command.script, script, error.message()));
    return folder;
}

struct Jobs {
    std::string render;
    std::string merge;
};

// Each submission has logs of its own, by the number of its job: Slurm's %A and %j. What an earlier
// one said is no news.
fs::path task_log(const fs::path& folder, const std::string& job, const std::string& task)
{
    return folder / fmt::format("log-{}-{}", job, task);
}
fs::path merge_log(const fs::path& folder, const std::string& job)
{
    return folder / fmt::format("log-{}-merge", job);
}

Jobs submit(const FarmCommand& command, const fs::path& folder)
{
    std::error_code ignored;
    if (const fs::path self = fs::read_symlink("/proc/self/exe", ignored); !ignored)
        setenv("DIPTYCH", self.c_str(), 0);
    const std::string script = folder / "render.sbatch";
    std::vector<std::string> words = command.sbatch;
    words.insert(words.end(), {fmt::format("--array=0-{}", command.tasks - 1),
                               "--output=" + task_log(folder, "%A", "%a").string(), script,
                               "render", std::to_string(command.samples), folder.string()});
    words.insert(words.end(), command.render.begin(), command.render.end());
    Jobs jobs;
    jobs.render = submit_job(words);

    words = command.sbatch;
    words.insert(words.end(), {"--dependency=afterok:" + jobs.render, "--kill-on-invalid-dep=yes",
                               "--output=" + merge_log(folder, "%j").string(), script, "merge",
                               std::to_string(command.tasks), folder.string()});
    for (const std::string& path : command.outputs) words.insert(words.end(), {"-o", path});
    for (const std::string& word : picture_words(command.view, command.write))
        words.push_back(word);
    jobs.merge = submit_job(words);
    return jobs;
}

double fraction_of(const FarmCommand& command)
{
    double sum = 0;
    for (int task = 0; task < command.tasks; ++task) {
        try {
            sum += fraction_done(slice_name(command, task));
        } catch (const std::runtime_error&) {
            // not begun
        }
    }
    return sum / command.tasks;
}

// The last line that a program has left in a log.
std::string last_line(const std::string& path)
{
    std::ifstream in(path);
    std::string line, last;
    while (std::getline(in, line))
        if (!line.empty()) last = line;
    return last;
}

[[noreturn]] void tell_what_failed(const FarmCommand& command, const fs::path& folder,
                                   const Jobs& jobs)
{
    for (int task = 0; task < command.tasks; ++task) {
        const std::string line = last_line(task_log(folder, jobs.render, std::to_string(task)));
        if (line.find("diptych: ") == 0)
            throw std::runtime_error(
                fmt::format("farm: task {}: {}", task, with_farms_advice(line.substr(9), command)));
    }
    const std::string line = last_line(merge_log(folder, jobs.merge));
    throw std::runtime_error(
        fmt::format("farm: there is no picture ({}); see the logs in {}, and submit again to go on "
                    "from the checkpoints there",
                    line.empty() ? "a task has failed" : line, folder.string()));
}

void show(double fraction, const JobCounts& counts, bool is_terminal)
{
    const std::string text = fmt::format("{:3.0f} %  {} running, {} waiting", 100 * fraction,
                                         counts.running, counts.waiting);
    if (is_terminal)
        fmt::print(stderr, "\r{}   ", text);
    else
        fmt::print(stderr, "{}\n", text);
    std::fflush(stderr);
}

// Until neither job is in the queue. False when interrupted.
bool watch(const FarmCommand& command, const Jobs& jobs)
{
    const std::atomic<bool>& is_interrupted = watch_for_interrupts();
    const bool is_terminal = isatty(STDERR_FILENO) != 0;
    std::string last;
    for (bool is_over = false; !is_over;) {
        JobCounts counts;
        if (count_jobs({jobs.render, jobs.merge}, counts)) {
            is_over = counts.running + counts.waiting == 0;
            const double fraction = fraction_of(command);
            const std::string now =
                fmt::format("{:.2f} {} {}", fraction, counts.running, counts.waiting);
            if (now != last) show(fraction, counts, is_terminal);
            last = now;
            if (counts.never) run_program({"scancel", jobs.merge});
        }
        for (int k = 0; k < 10 && !is_over; ++k) {
            if (is_interrupted) return false;
            std::this_thread::sleep_for(std::chrono::milliseconds(100));
        }
    }
    if (is_terminal) fmt::print(stderr, "\n");
    return true;
}

// When each was written; the least time: never. Only compared for being the same: clocks of many
// machines need not agree, nor go forwards.
std::vector<fs::file_time_type> times_of(const std::vector<std::string>& paths)
{
    std::vector<fs::file_time_type> times;
    for (const std::string& path : paths) {
        std::error_code error;
        const fs::file_time_type time = fs::last_write_time(path, error);
        times.push_back(error ? fs::file_time_type::min() : time);
    }
    return times;
}

bool are_written_since(const std::vector<std::string>& paths,
                       const std::vector<fs::file_time_type>& before)
{
    const std::vector<fs::file_time_type> now = times_of(paths);
    for (size_t k = 0; k < now.size(); ++k)
        if (now[k] == before[k]) return false;
    return true;
}

}  // namespace

CLI::App* add_farm_command(CLI::App& app, FarmCommand& command)
{
    CLI::App* farm = app.add_subcommand("farm", "Render a picture on many machines, with Slurm");
    farm->allow_extras();
    farm->add_option("--tasks", command.tasks, "Slices, each a task of its own")
        ->required()
        ->check(CLI::Range(1, 100000));
    farm->add_option("--samples", command.samples, "Samples a pixel, in all")
        ->capture_default_str()
        ->check(CLI::Range(1, 1 << 24));
    farm->add_option("-o,--output", command.outputs,
                     "Picture to write, as of diptych render. May be given more than once")
        ->allow_extra_args(false)
        ->required();
    add_picture_flags(*farm, command.view, command.write);
    farm->add_option("--folder", command.folder,
                     "For checkpoints and logs; all machines must see it. Default: the first "
                     "picture's name and .farm. What it holds is continued");
    farm->add_option("--sbatch", command.sbatch,
                     "A word for sbatch, as --sbatch=--partition=long. May be given more than once")
        ->allow_extra_args(false);
    farm->add_option("--script", command.script,
                     "Submit this in place of ci/slurm/render.sbatch, which the program holds");
    farm->add_flag("--detach", command.is_detached, "Submit, and do not wait");
    farm->footer("Everything else, the scene first, is given to diptych render.\n"
                 "Exit codes: 0 the picture is there, 2 error, 130 no longer watched (the jobs go "
                 "on).");
    farm->callback([farm, &command] { command.render = farm->remaining(); });
    return farm;
}

int run_farm_command(const FarmCommand& command)
{
    check_farm(command);
    const fs::path folder = make_folder(command);
    const std::vector<fs::file_time_type> before = times_of(command.outputs);
    const Jobs jobs = submit(command, folder);
    fmt::print(stderr, "job {}: {} tasks; job {} merges them; checkpoints and logs in {}\n",
               jobs.render, command.tasks, jobs.merge, folder.string());
    if (command.is_detached) return 0;
    if (!watch(command, jobs)) {
        fmt::print(stderr, "\nno longer watching; the jobs go on (scancel {} {} ends them)\n",
                   jobs.render, jobs.merge);
        return 130;
    }
    if (!are_written_since(command.outputs, before)) tell_what_failed(command, folder, jobs);
    for (const std::string& path : command.outputs) fmt::print(stderr, "wrote {}\n", path);
    return 0;
}

}  // namespace diptych
