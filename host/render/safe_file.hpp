// Files that survive the end of the program and of the machine at any moment: written under another
// name, made durable, then put in place of the one before; and a lock, so that only one process
// does so.
#pragma once

#include "host/image/whole_file.hpp"

#include <string>

namespace diptych {

// A new version of a file, by the one writer who holds its FileLock.
class SafeFile : public image::WholeFile {
public:
    explicit SafeFile(const std::string& path) : WholeFile(path, image::Survives::Machine) {}
};

// Held from construction to the end, also if that is a kill: by flock(2) on "FILE.lock" beside
// the file that the path leads to. Throws when another process holds it, when the folder cannot be
// written, and when the path does not lead to a file.
class FileLock {
public:
    explicit FileLock(const std::string& path);
    ~FileLock();
    FileLock(const FileLock&) = delete;
    FileLock& operator=(const FileLock&) = delete;

private:
    std::string name_;
    int file_ = -1;
};

}  // namespace diptych
