// Files that survive the end of the program and of the machine at any moment: written under another
// name, made durable, then put in place of the one before; and a lock, so that only one process
// does so.
#pragma once

#include <cstddef>
#include <string>

namespace diptych {

// A new version of a file. Until put_in_place() has returned, the version before it is untouched.
// All throw std::runtime_error (path: what; what to do). One writer at a time: hold the FileLock.
class SafeFile {
public:
    explicit SafeFile(std::string path);
    ~SafeFile();  // removes what was not put in place
    SafeFile(const SafeFile&) = delete;
    SafeFile& operator=(const SafeFile&) = delete;

    void write(const void* data, size_t bytes);
    // Waits for the disk, renames, and waits for the folder. May be called on another thread.
    void put_in_place();

private:
    std::string path_;
    std::string temporary_;
    int file_ = -1;
};

// Held from construction to the end, also if that is a kill: by flock(2) on "PATH.lock". Throws
// when another process holds it, and when the folder cannot be written.
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
