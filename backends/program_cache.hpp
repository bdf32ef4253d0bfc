// Compiled programs on disk, shared by all processes of a user.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace diptych {

// Entries are files of their own: written under a temporary name and renamed, so that others see
// a whole entry or none; read back only if the checksum inside agrees. Nothing here throws: a cache
// that cannot be used costs time, not the picture.
class ProgramCache {
public:
    // $DIPTYCH_CACHE_DIR, else $XDG_CACHE_HOME/diptych, else ~/.cache/diptych; none: no cache.
    static std::filesystem::path default_folder();

    explicit ProgramCache(std::filesystem::path folder);

    // `key`: a name without path separators that stands for all that went into the program.
    std::optional<std::string> load(const std::string& key) const;
    void store(const std::string& key, const std::string& binary);

    // Why entries are not kept; empty when they are.
    const std::string& notice() const { return notice_; }

private:
    std::filesystem::path folder_;
    std::string notice_;
};

}  // namespace diptych
