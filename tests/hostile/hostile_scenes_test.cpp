// Files that others made to break loaders: each renders, or is refused with one line; none crashes
// or hangs, and a refusal leaves no picture.
#include "tests/host/commands/program.hpp"

#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <mutex>

namespace {

namespace fs = std::filesystem;

std::vector<fs::path> files_under(const std::string& prefix, const std::vector<std::string>& kinds)
{
    std::vector<fs::path> files;
    const fs::path scenes = fs::path(DIPTYCH_SHARED) / "scenes";
    if (!fs::exists(scenes)) return files;
    for (const auto& folder : fs::directory_iterator(scenes)) {
        if (folder.path().filename().string().rfind(prefix, 0) != 0) continue;
        for (const auto& entry : fs::recursive_directory_iterator(folder)) {
            const std::string kind = entry.path().extension().string();
            if (entry.is_regular_file() && std::count(kinds.begin(), kinds.end(), kind) > 0)
                files.push_back(entry.path());
        }
    }
    std::sort(files.begin(), files.end());
    return files;
}

// Of more than 60, sixty: a process each takes its time, and the loader's own tests read all.
std::vector<fs::path> some_of(const std::vector<fs::path>& files)
{
    const size_t step = (files.size() + 59) / 60;
    std::vector<fs::path> some;
    for (size_t k = 0; k < files.size(); k += step) some.push_back(files[k]);
    return some;
}

// Nothing if all is well, else what is not.
std::string complaint(const std::vector<std::string>& words, const TestFolder& folder, size_t k)
{
    const std::string picture = folder / (std::to_string(k) + ".exr");
    std::vector<std::string> all = {"render",    "--size", "16x16",   "--samples", "1",
                                    "--threads", "1",      "--quiet", "-o",        picture};
    all.insert(all.end(), words.begin(), words.end());
    const Outcome outcome = run_diptych(all, {.seconds = 60});
    const bool is_written = fs::exists(picture);
    if (is_written) fs::remove(picture);
    if (outcome.has_timed_out || outcome.signal != 0) return outcome.text();
    if (outcome.exit_code == 0) return is_written ? "" : "no picture\n" + outcome.text();
    const std::vector<std::string> lines = outcome.err_lines();
    const bool is_clean = outcome.exit_code == 2 && lines.size() == 1 &&
                          lines[0].rfind("diptych: ", 0) == 0 && !is_written;
    return is_clean ? "" : outcome.text();
}

void check_all(const std::vector<std::vector<std::string>>& calls)
{
    const TestFolder folder;
    std::mutex mutex;
    tbb::parallel_for(size_t(0), calls.size(), [&](size_t k) {
        const std::string found = complaint(calls[k], folder, k);
        const std::lock_guard lock(mutex);
        if (!found.empty()) ADD_FAILURE() << calls[k].back() << "\n" << found;
    });
    EXPECT_TRUE(folder.files().empty()) << "something was left behind";
}

TEST(HostileScenes, RenderOrAreRefused)
{
    std::vector<std::vector<std::string>> calls;
    for (const char* prefix : {"hostile-", "mesh-"})
        for (const fs::path& file : some_of(files_under(prefix, {".gltf", ".glb"})))
            calls.push_back({file.string()});
    if (calls.empty()) GTEST_SKIP() << "not there: " << DIPTYCH_SHARED << "/scenes/hostile-*";
    check_all(calls);
}

TEST(HostileScenes, OtherFormatsAreRefused)
{
    std::vector<std::vector<std::string>> calls;
    for (const fs::path& file : files_under("mesh-", {".obj", ".ply", ".stl", ".STL"}))
        calls.push_back({file.string()});
    if (calls.empty()) GTEST_SKIP() << "not there: " << DIPTYCH_SHARED << "/scenes/mesh-*";
    check_all(calls);
}

// As environments: the same decoders, reached by another way.
TEST(HostileScenes, PicturesAsEnvironments)
{
    const TestFolder folder;
    const std::string nothing = folder.write("nothing.gltf", R"({"asset": {"version": "2.0"}})");
    const std::vector<std::string> kinds = {".exr", ".jpg", ".png", ".tif", ".tiff",
                                            ".bmp", ".gif", ".tga", ".hdr"};
    std::vector<std::vector<std::string>> calls;
    for (const fs::path& file : some_of(files_under("hostile-", kinds)))
        calls.push_back({nothing, "--env", file.string()});
    if (calls.empty()) GTEST_SKIP() << "not there: " << DIPTYCH_SHARED << "/scenes/hostile-*";
    check_all(calls);
}

}  // namespace
