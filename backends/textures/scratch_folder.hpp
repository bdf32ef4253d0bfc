// Files for other programs to read and write.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>

namespace diptych {

// A folder of its own among the temporary ones, gone at the end.
class ScratchFolder {
public:
    // Throws std::runtime_error when it cannot be made.
    ScratchFolder()
    {
        std::string pattern =
            (std::filesystem::temp_directory_path() / "diptych-texture-XXXXXX").string();
        if (!mkdtemp(pattern.data()))
            throw std::runtime_error(pattern + ": cannot be made; free the disk or set TMPDIR");
        path_ = pattern;
    }
    ~ScratchFolder()
    {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    ScratchFolder(const ScratchFolder&) = delete;
    ScratchFolder& operator=(const ScratchFolder&) = delete;
    std::string operator/(const char* name) const { return (path_ / name).string(); }

private:
    std::filesystem::path path_;
};

// A file's bytes; of one that cannot be read, none.
inline std::string text_of(const std::filesystem::path& file)
{
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

}  // namespace diptych
