#include "host/commands/slurm.hpp"

#include "backends/textures/subprocess.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <sstream>
#include <stdexcept>

namespace diptych {
namespace {

std::string on_one_line(std::string text)
{
    while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back()))) text.pop_back();
    std::replace(text.begin(), text.end(), '\n', ' ');
    return text;
}

bool is_number(const std::string& text)
{
    return !text.empty() && std::all_of(text.begin(), text.end(),
                                        [](unsigned char c) { return std::isdigit(c) != 0; });
}

}  // namespace

void expect_slurm()
{
    for (const char* program : {"sbatch", "squeue"})
        if (find_program(program).empty())
            throw std::runtime_error(
                fmt::format("farm: no {} on the PATH; run it where Slurm's commands are installed, "
                            "or render slices with diptych render --range",
                            program));
}

std::string submit_job(const std::vector<std::string>& sbatch_arguments)
{
    std::vector<std::string> words = {"sbatch", "--parsable"};
    words.insert(words.end(), sbatch_arguments.begin(), sbatch_arguments.end());
    const Finished finished = run_program(words);
    // the number comes last, after warnings, with the cluster's name behind a semicolon
    std::istringstream lines(finished.output);
    std::string line, job;
    while (std::getline(lines, line)) {
        const std::string number = line.substr(0, line.find(';'));
        if (is_number(number)) job = number;
    }
    if (finished.exit_code != 0 || job.empty())
        throw std::runtime_error(
            fmt::format("farm: sbatch refused the job ({}); see sinfo, and give sbatch what it "
                        "needs with --sbatch",
                        on_one_line(finished.output)));
    return job;
}

bool count_jobs(const std::vector<std::string>& jobs, JobCounts& counts)
{
    counts = {};
    // asked for all jobs of this user: a number that is known no more would be an error
    const Finished finished =
        run_program({"squeue", "--me", "--noheader", "--array", "--format=%A %F %t %r"});
    if (finished.exit_code != 0) return false;
    std::istringstream lines(finished.output);
    std::string line;
    while (std::getline(lines, line)) {
        std::istringstream words(line);
        std::string job, array, state, reason;
        words >> job >> array >> state >> reason;
        if (std::count(jobs.begin(), jobs.end(), array) == 0) continue;
        if (reason == "DependencyNeverSatisfied") counts.never = true;
        ++(state == "R" || state == "CG" ? counts.running : counts.waiting);
    }
    return true;
}

}  // namespace diptych
