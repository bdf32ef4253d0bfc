// Files that appear whole or not at all: written under another name in the same folder, then
// renamed. This is the only place that puts something where a user's file may be. A symbolic link
// is followed, and stays. What is no file (a pipe, a device) is never replaced: texts go straight
// into it, the rest is refused. All throw std::runtime_error (path: what; what to do).
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace diptych::image {

// What is at the end of a path's symbolic links, whether it exists or not.
std::string file_behind(const std::string& path);

// Throws for a path that leads to a folder, a pipe, a device, ...
void expect_replaceable(const std::string& path);

enum class Survives {
    Program,  // readers find the old version or the new one; several may write at once
    Machine,  // and so it is after a power cut. Only one may write, who holds a lock: what one that
              // was killed leaves behind is overwritten by the next
};

// A new version of a file. Until put_in_place() has returned, the version before it is untouched.
class WholeFile {
public:
    WholeFile(const std::string& path, Survives survives);
    ~WholeFile();  // removes what was not put in place
    WholeFile(const WholeFile&) = delete;
    WholeFile& operator=(const WholeFile&) = delete;

    void write(const void* data, size_t bytes);
    // Survives::Machine: waits for the disk and for the folder. May be called on another thread.
    void put_in_place();

private:
    std::string target_;
    std::string name_;  // as messages give it
    std::string temporary_;
    Survives survives_;
    int file_ = -1;
};

// Also into pipes, devices and /dev/stdout.
void write_text(const std::string& path, std::string_view text);
void check_text_writable(const std::string& path);  // throws now what write_text would

}  // namespace diptych::image
