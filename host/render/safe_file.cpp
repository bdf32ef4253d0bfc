#include "host/render/safe_file.hpp"

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <fmt/format.h>
#include <stdexcept>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>
#include <utility>

namespace diptych {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const std::string& path, const std::string& what, int error,
                       const std::string& remedy)
{
    throw std::runtime_error(
        fmt::format("{}: {} ({}); {}", path, what, std::strerror(error), remedy));
}

constexpr const char* free_space = "make room; the version before it is untouched";

std::string folder_of(const std::string& path)
{
    const fs::path folder = fs::path(path).parent_path();
    return folder.empty() ? "." : folder.string();
}

// A rename is durable once its folder is.
void sync_folder(const std::string& path)
{
    const int folder = open(folder_of(path).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (folder < 0) return;  // a folder that may be written but not read
    fsync(folder);           // not every file system can, and the file itself is safe
    close(folder);
}

bool is_same_file(int file, const std::string& name)
{
    struct stat open_one = {}, named = {};
    return fstat(file, &open_one) == 0 && stat(name.c_str(), &named) == 0 &&
           open_one.st_ino == named.st_ino && open_one.st_dev == named.st_dev;
}

std::string temporary_beside(const std::string& path)
{
    return (fs::path(folder_of(path)) / fmt::format(".{}.new", fs::path(path).filename().string()))
        .string();
}

}  // namespace

SafeFile::SafeFile(std::string path) : path_(std::move(path)), temporary_(temporary_beside(path_))
{
    std::error_code ignored;
    if (fs::is_directory(path_, ignored)) fail(path_, "cannot be written", EISDIR, "name a file");
    file_ = open(temporary_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    if (file_ < 0)
        fail(path_, "cannot be written", errno,
             "check that its folder exists and is yours to write");
}

SafeFile::~SafeFile()
{
    if (file_ < 0) return;
    close(file_);
    unlink(temporary_.c_str());
}

void SafeFile::write(const void* data, size_t bytes)
{
    const char* from = static_cast<const char*>(data);
    while (bytes > 0) {
        const ssize_t written = ::write(file_, from, bytes);
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) fail(path_, "could not be written whole", errno, free_space);
        from += written;
        bytes -= size_t(written);
    }
}

void SafeFile::put_in_place()
{
    // EINVAL: not a file that can be synchronised, such as a pipe
    if (fsync(file_) != 0 && errno != EINVAL)
        fail(path_, "could not be written whole", errno, free_space);
    if (close(std::exchange(file_, -1)) != 0) {
        const int error = errno;
        unlink(temporary_.c_str());
        fail(path_, "could not be written whole", error, free_space);
    }
    if (rename(temporary_.c_str(), path_.c_str()) != 0) {
        const int error = errno;
        unlink(temporary_.c_str());
        fail(path_, "cannot be replaced", error, "check that its folder is yours to write");
    }
    sync_folder(path_);
}

FileLock::FileLock(const std::string& path) : name_(path + ".lock")
{
    // The lock that was taken may be one that its holder has just removed: then there is a new one.
    do {
        if (file_ >= 0) close(file_);
        file_ = open(name_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
        if (file_ < 0)
            fail(path, "its lock cannot be made", errno,
                 "check that its folder exists and is yours to write");
        if (flock(file_, LOCK_EX | LOCK_NB) != 0) {
            const int error = errno;
            close(std::exchange(file_, -1));
            if (error == EWOULDBLOCK)
                throw std::runtime_error(path + ": another process is writing it; wait for that "
                                                "one, or name another file");
            fail(path, "cannot be locked", error, "use a folder whose file system has locks");
        }
    } while (!is_same_file(file_, name_));
}

FileLock::~FileLock()
{
    if (file_ < 0) return;
    unlink(name_.c_str());
    close(file_);
}

}  // namespace diptych
