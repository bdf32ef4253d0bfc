#include "host/render/safe_file.hpp"

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <fmt/format.h>
#include <stdexcept>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>
#include <utility>

namespace diptych {
namespace {

[[noreturn]] void fail(const std::string& path, const std::string& what, int error,
                       const std::string& remedy)
{
    throw std::runtime_error(
        fmt::format("{}: {} ({}); {}", path, what, std::strerror(error), remedy));
}

bool is_same_file(int file, const std::string& name)
{
    struct stat open_one = {}, named = {};
    return fstat(file, &open_one) == 0 && stat(name.c_str(), &named) == 0 &&
           open_one.st_ino == named.st_ino && open_one.st_dev == named.st_dev;
}

}  // namespace

FileLock::FileLock(const std::string& path) : name_(image::file_behind(path) + ".lock")
{
    image::expect_replaceable(path);
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
