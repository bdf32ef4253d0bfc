#include "backends/program_cache.hpp"

#include "backends/sha256.hpp"

#include <atomic>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <random>
#include <sstream>

namespace diptych {
namespace {

constexpr size_t digest_length = 64;

std::string digest(const std::string& data)
{
    Sha256 hash;
    hash.add(data);
    return hash.finish();
}

std::string environment(const char* name)
{
    const char* value = std::getenv(name);
    return value ? value : "";
}

// Different in every process and thread.
std::string unique_suffix()
{
    static std::atomic<unsigned> counter{0};
    std::random_device random;
    std::ostringstream suffix;
    suffix << '.' << random() << '-' << counter++ << ".tmp";
    return suffix.str();
}

bool write_file(const std::filesystem::path& path, const std::string& data)
{
    std::ofstream file(path, std::ios::binary);
    file << digest(data) << data;
    file.close();
    return file.good();
}

}  // namespace

std::filesystem::path ProgramCache::default_folder()
{
    if (const std::string folder = environment("DIPTYCH_CACHE_DIR"); !folder.empty()) return folder;
    if (const std::string folder = environment("XDG_CACHE_HOME"); !folder.empty())
        return std::filesystem::path(folder) / "diptych";
    if (const std::string home = environment("HOME"); !home.empty())
        return std::filesystem::path(home) / ".cache" / "diptych";
    return {};
}

ProgramCache::ProgramCache(std::filesystem::path folder) : folder_(std::move(folder))
{
    std::error_code error;
    if (folder_.empty())
        notice_ = "no program cache: neither DIPTYCH_CACHE_DIR nor HOME is set";
    else if (std::filesystem::create_directories(folder_, error); error)
        notice_ = "no program cache: " + folder_.string() + ": " + error.message();
}

std::optional<std::string> ProgramCache::load(const std::string& key) const
{
    if (folder_.empty()) return std::nullopt;
    std::ifstream file(folder_ / key, std::ios::binary);
    if (!file) return std::nullopt;
    const std::string entry{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
    if (entry.size() <= digest_length) return std::nullopt;
    std::string data = entry.substr(digest_length);
    if (digest(data) != entry.substr(0, digest_length)) return std::nullopt;
    return data;
}

void ProgramCache::store(const std::string& key, const std::string& binary)
{
    if (!notice_.empty()) return;
    const std::filesystem::path path = folder_ / key;
    const std::filesystem::path temporary = path.string() + unique_suffix();
    std::error_code error;
    if (write_file(temporary, binary))
        std::filesystem::rename(temporary, path, error);
    else
        error = std::make_error_code(std::errc::io_error);
    if (!error) return;
    notice_ = "program cache not written: " + path.string() + ": " + error.message();
    std::filesystem::remove(temporary, error);
}

}  // namespace diptych
