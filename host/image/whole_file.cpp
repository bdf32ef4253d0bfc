#include "host/image/whole_file.hpp"

#include <fmt/format.h>

#include <atomic>
#include <cerrno>
#include <charconv>
#include <cstdio>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <stdexcept>
#include <sys/stat.h>
#include <unistd.h>
#include <utility>

namespace diptych::image {
namespace {

namespace fs = std::filesystem;

constexpr int most_links = 40;  // as Linux has it
constexpr const char* folder_remedy = "check that its folder exists and is yours to write";
constexpr const char* room_remedy = "make room; the version before it is untouched";

[[noreturn]] void fail(const std::string& name, const std::string& what, int error,
                       const std::string& remedy)
{
    throw std::runtime_error(
        fmt::format("{}: {} ({}); {}", name, what, std::strerror(error), remedy));
}

fs::path folder_of(const fs::path& path)
{
    return path.has_parent_path() ? path.parent_path() : fs::path(".");
}

// Where a path leads.
struct Target {
    fs::path file;
    int descriptor = -1;  // one of ours, for /dev/stdout and its like
    mode_t mode = 0;      // of what is there; 0: nothing is
};

int number_of(const std::string& text)
{
    int number = -1;
    std::from_chars(text.data(), text.data() + text.size(), number);
    return number;
}

Target find_target(const std::string& path)
{
    Target target{path};
    std::error_code none;
    const fs::path descriptors = fs::canonical("/proc/self/fd", none);
    for (int links = 0; fs::is_symlink(fs::symlink_status(target.file, none)); ++links) {
        if (links == most_links)
            throw std::runtime_error(path + ": leads through links in a circle; name a file");
        const fs::path folder = fs::canonical(folder_of(target.file), none);
        if (!descriptors.empty() && folder == descriptors) {
            target.descriptor = number_of(target.file.filename());
            break;
        }
        target.file = folder / fs::read_symlink(target.file, none);
    }
    struct stat status = {};
    if (stat(path.c_str(), &status) == 0) target.mode = status.st_mode;
    return target;
}

const char* kind_of(const Target& target)
{
    if (target.descriptor >= 0) return "an open file of this program";
    if (S_ISFIFO(target.mode)) return "a pipe";
    if (S_ISSOCK(target.mode)) return "a socket";
    return "a device";
}

void expect_replaceable(const std::string& path, const Target& target)
{
    if (S_ISDIR(target.mode)) throw std::runtime_error(path + ": is a folder; name a file");
    if (target.descriptor < 0 && (target.mode == 0 || S_ISREG(target.mode))) return;
    throw std::runtime_error(fmt::format(
        "{}: is {}, and only a file can be replaced whole; name a file", path, kind_of(target)));
}

bool takes_text(const Target& target)
{
    return target.descriptor >= 0 || S_ISFIFO(target.mode) || S_ISCHR(target.mode);
}

std::string temporary_beside(const fs::path& path, Survives survives)
{
    static std::atomic<unsigned> counter = 0;
    const std::string name = path.filename().string();
    return (folder_of(path) / (survives == Survives::Machine
                                   ? fmt::format(".{}.new", name)
                                   : fmt::format(".{}.{}.{}.tmp", name, getpid(), counter++)))
        .string();
}

// The error, or 0.
int write_all(int file, const void* data, size_t bytes)
{
    const char* from = static_cast<const char*>(data);
    while (bytes > 0) {
        const ssize_t written = write(file, from, bytes);
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) return errno;
        from += written;
        bytes -= size_t(written);
    }
    return 0;
}

// A rename is durable once its folder is.
void sync_folder(const std::string& path)
{
    const int folder = open(folder_of(path).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (folder < 0) return;  // a folder that may be written but not read
    fsync(folder);           // not every file system can, and the file itself is safe
    close(folder);
}

void write_through(const std::string& path, const Target& target, std::string_view text)
{
    std::fflush(stdout);  // where it is the target, what was printed comes first
    const int file = target.descriptor >= 0 ? fcntl(target.descriptor, F_DUPFD_CLOEXEC, 0)
                                            : open(path.c_str(), O_WRONLY | O_NOCTTY | O_CLOEXEC);
    if (file < 0) fail(path, "cannot be written", errno, "check its permissions, or name a file");
    const int error = write_all(file, text.data(), text.size());
    close(file);
    if (error != 0) fail(path, "could not be written whole", error, "name a file");
}

}  // namespace

std::string file_behind(const std::string& path) { return find_target(path).file.string(); }

void expect_replaceable(const std::string& path) { expect_replaceable(path, find_target(path)); }

WholeFile::WholeFile(const std::string& path, Survives survives) : name_(path), survives_(survives)
{
    const Target target = find_target(path);
    expect_replaceable(path, target);
    target_ = target.file.string();
    if (target_ != path) name_ += " -> " + target_;
    temporary_ = temporary_beside(target.file, survives);
    const int reuse = survives == Survives::Machine ? O_TRUNC : O_EXCL;
    file_ = open(temporary_.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC | reuse, 0666);
    if (file_ < 0) fail(name_, "cannot be written", errno, folder_remedy);
}

WholeFile::~WholeFile()
{
    if (file_ < 0) return;
    close(file_);
    unlink(temporary_.c_str());
}

void WholeFile::write(const void* data, size_t bytes)
{
    if (const int error = write_all(file_, data, bytes))
        fail(name_, "could not be written whole", error, room_remedy);
}

void WholeFile::put_in_place()
{
    // EINVAL: of a file system that cannot
    if (survives_ == Survives::Machine && fsync(file_) != 0 && errno != EINVAL)
        fail(name_, "could not be written whole", errno, room_remedy);
    if (close(std::exchange(file_, -1)) != 0) {
        const int error = errno;
        unlink(temporary_.c_str());
        fail(name_, "could not be written whole", error, room_remedy);
    }
    if (rename(temporary_.c_str(), target_.c_str()) != 0) {
        const int error = errno;
        unlink(temporary_.c_str());
        fail(name_, "cannot be replaced", error, "check that its folder is yours to write");
    }
    if (survives_ == Survives::Machine) sync_folder(target_);
}

void write_text(const std::string& path, std::string_view text)
{
    if (const Target target = find_target(path); takes_text(target))
        return write_through(path, target, text);
    WholeFile file(path, Survives::Program);
    file.write(text.data(), text.size());
    file.put_in_place();
}

// A pipe is not opened for that: its reader would see it end.
void check_text_writable(const std::string& path)
{
    const Target target = find_target(path);
    if (!takes_text(target))
        WholeFile probe(path, Survives::Program);
    else if (target.descriptor < 0 && access(path.c_str(), W_OK) != 0)
        fail(path, "cannot be written", errno, "check its permissions, or name a file");
}

}  // namespace diptych::image
