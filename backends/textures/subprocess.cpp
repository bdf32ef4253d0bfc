#include "backends/textures/subprocess.hpp"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <spawn.h>
#include <stdexcept>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

extern char** environ;

namespace diptych {
namespace {

std::string read_all(int descriptor)
{
    std::string text;
    char buffer[4096];
    for (;;) {
        const ssize_t got = read(descriptor, buffer, sizeof buffer);
        if (got < 0 && errno == EINTR) continue;
        if (got <= 0) return text;
        text.append(buffer, size_t(got));
    }
}

}  // namespace

Finished run_program(const std::vector<std::string>& arguments)
{
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0)
        throw std::runtime_error(arguments[0] + ": cannot be started: " + std::strerror(errno));
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_adddup2(&actions, ends[1], 1);
    posix_spawn_file_actions_adddup2(&actions, ends[1], 2);
    std::vector<char*> words;
    for (const std::string& argument : arguments)
        words.push_back(const_cast<char*>(argument.c_str()));
    words.push_back(nullptr);
    pid_t child = 0;
    const int error = posix_spawnp(&child, words[0], &actions, nullptr, words.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    close(ends[1]);
    Finished finished;
    if (error == 0) finished.output = read_all(ends[0]);
    close(ends[0]);
    if (error != 0)
        throw std::runtime_error(arguments[0] + ": cannot be started: " + std::strerror(error));
    int status = 0;
    rusage used{};
    while (wait4(child, &status, 0, &used) < 0 && errno == EINTR) {
    }
    for (const timeval& time : {used.ru_utime, used.ru_stime})  // as the limit counts
        finished.seconds += double(time.tv_sec) + 1e-6 * double(time.tv_usec);
    finished.exit_code = WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
    return finished;
}

Finished run_program_within(int seconds, int gibibytes, const std::vector<std::string>& arguments)
{
    // The shell sets limits and becomes the program, whose words it does not read.
    std::vector<std::string> limited = {"/bin/sh",
                                        "-c",
                                        "ulimit -t \"$1\"; ulimit -v \"$2\"; shift 2; exec \"$@\"",
                                        "limits",
                                        std::to_string(seconds),
                                        std::to_string(gibibytes << 20)};
    limited.insert(limited.end(), arguments.begin(), arguments.end());
    return run_program(limited);
}

std::string find_program(const std::string& name)
{
    const auto is_program = [](const std::string& path) {
        return access(path.c_str(), X_OK) == 0 && std::filesystem::is_regular_file(path);
    };
    if (name.find('/') != std::string::npos) return is_program(name) ? name : "";
    const char* path = std::getenv("PATH");
    std::string rest = path ? path : "/usr/bin:/bin";
    while (!rest.empty()) {
        const size_t colon = rest.find(':');
        const std::string folder = rest.substr(0, colon);
        if (!folder.empty() && is_program(folder + "/" + name)) return folder + "/" + name;
        rest = colon == std::string::npos ? "" : rest.substr(colon + 1);
    }
    return "";
}

}  // namespace diptych
