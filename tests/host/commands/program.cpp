#include "tests/host/commands/program.hpp"

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <fcntl.h>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

namespace {

using Clock = std::chrono::steady_clock;

// An open file without a name: both ends of what a program prints.
class Capture {
public:
    Capture()
    {
        std::string name = (std::filesystem::temp_directory_path() / "diptych-run-XXXXXX").string();
        file_ = mkstemp(name.data());
        if (file_ < 0) throw std::runtime_error(name + ": cannot be made");
        unlink(name.c_str());
    }
    ~Capture() { close(file_); }
    Capture(const Capture&) = delete;
    Capture& operator=(const Capture&) = delete;

    int file() const { return file_; }
    std::string text() const
    {
        std::string all(size_t(lseek(file_, 0, SEEK_END)), '\0');
        const ssize_t got = pread(file_, all.data(), all.size(), 0);
        all.resize(size_t(std::max<ssize_t>(got, 0)));
        return all;
    }

private:
    int file_;
};

// In the child; never returns.
[[noreturn]] void become(char* const* words, const RunOptions& options, int out, int err)
{
    if (!options.folder.empty() && chdir(options.folder.c_str()) != 0) _exit(126);
    for (const auto& [name, value] : options.environment) setenv(name.c_str(), value.c_str(), 1);
    const int nothing = open("/dev/null", O_RDONLY);
    dup2(nothing, STDIN_FILENO);
    dup2(out, STDOUT_FILENO);
    dup2(err, STDERR_FILENO);
    execvp(words[0], words);
    _exit(127);
}

}  // namespace

std::vector<std::string> Outcome::err_lines() const
{
    std::vector<std::string> lines;
    for (size_t at = 0; at < err.size();) {
        const size_t end = std::min(err.find('\n', at), err.size());
        lines.push_back(err.substr(at, end - at));
        at = end + 1;
    }
    return lines;
}

std::string Outcome::text() const
{
    return "exit code " + std::to_string(exit_code) + ", signal " + std::to_string(signal) +
           (has_timed_out ? ", timed out" : "") + "\n" + out + err;
}

Outcome run_program(const std::vector<std::string>& words, const RunOptions& options)
{
    const Capture out, err;
    std::vector<char*> pointers;
    for (const std::string& word : words) pointers.push_back(const_cast<char*>(word.c_str()));
    pointers.push_back(nullptr);
    const pid_t child = fork();
    if (child < 0) throw std::runtime_error("fork failed");
    if (child == 0) become(pointers.data(), options, out.file(), err.file());

    Outcome outcome;
    bool is_signalled = options.signal == 0;
    const auto start = Clock::now();
    int status = 0;
    while (waitpid(child, &status, WNOHANG) == 0) {
        std::this_thread::sleep_for(std::chrono::milliseconds(3));
        if (!is_signalled && err.text().find(options.wait_for) != std::string::npos) {
            kill(child, options.signal);
            is_signalled = true;
        }
        if (std::chrono::duration<double>(Clock::now() - start).count() > options.seconds) {
            outcome.has_timed_out = true;
            kill(child, SIGKILL);
            waitpid(child, &status, 0);
            break;
        }
    }
    if (WIFEXITED(status)) outcome.exit_code = WEXITSTATUS(status);
    if (WIFSIGNALED(status)) outcome.signal = WTERMSIG(status);
    outcome.out = out.text();
    outcome.err = err.text();
    return outcome;
}

std::string diptych_program() { return DIPTYCH_PROGRAM; }

Outcome run_diptych(std::vector<std::string> arguments, const RunOptions& options)
{
    arguments.insert(arguments.begin(), diptych_program());
    return run_program(arguments, options);
}

TestFolder::TestFolder()
{
    std::string name = (std::filesystem::temp_directory_path() / "diptych-test-XXXXXX").string();
    if (!mkdtemp(name.data())) throw std::runtime_error(name + ": cannot be made");
    path_ = name;
}

TestFolder::~TestFolder()
{
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
}

std::string TestFolder::write(const std::string& name, const std::string& bytes) const
{
    std::ofstream(path_ / name, std::ios::binary) << bytes;
    return *this / name;
}

std::vector<std::string> TestFolder::files() const
{
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(path_))
        names.push_back(entry.path().filename().string());
    std::sort(names.begin(), names.end());
    return names;
}
