// The little of Slurm that `diptych farm` needs: its programs, run and understood.
#pragma once

#include <string>
#include <vector>

namespace diptych {

// Submits a batch script. Throws std::runtime_error with what sbatch says. The job's number.
std::string submit_job(const std::vector<std::string>& sbatch_arguments);

struct JobCounts {
    int waiting = 0;
    int running = 0;
    bool never = false;  // waits for what will not happen
};
// Tasks of the jobs that are not over yet. False when the controller does not answer.
bool count_jobs(const std::vector<std::string>& jobs, JobCounts& counts);

// Throws std::runtime_error unless sbatch and squeue are on the PATH.
void expect_slurm();

}  // namespace diptych
