// Runs the built diptych as a user would, and says what became of it.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

struct Outcome {
    int exit_code = -1;  // when it exited
    int signal = 0;      // when one ended it
    bool has_timed_out = false;
    std::string out;
    std::string err;

    std::vector<std::string> err_lines() const;
    std::string text() const;  // all of it, for messages
};

struct RunOptions {
    double seconds = 60;                               // then it is killed
    std::map<std::string, std::string> environment{};  // beside what is inherited
    std::string wait_for{};  // once standard error holds this, `signal` is sent
    int signal = 0;
    std::filesystem::path folder{};  // to run in; empty: here
};

// A program found by the PATH, or by its path.
Outcome run_program(const std::vector<std::string>& words, const RunOptions& options = {});
Outcome run_diptych(std::vector<std::string> arguments, const RunOptions& options = {});
std::string diptych_program();

// A folder for one test's files, empty at first, gone afterwards.
class TestFolder {
public:
    TestFolder();
    ~TestFolder();
    TestFolder(const TestFolder&) = delete;
    TestFolder& operator=(const TestFolder&) = delete;

    std::filesystem::path path() const { return path_; }
    std::string operator/(const std::string& name) const { return (path_ / name).string(); }
    std::string write(const std::string& name, const std::string& bytes) const;
    std::vector<std::string> files() const;

private:
    std::filesystem::path path_;
};
