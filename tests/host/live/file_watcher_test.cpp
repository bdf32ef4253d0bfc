// However a file is saved, it is noticed once, when it is whole, and only if it is another.
#include "host/live/file_watcher.hpp"

#include "tests/host/commands/program.hpp"

#include <gtest/gtest.h>

namespace {

namespace fs = std::filesystem;
using diptych::FileWatcher;
using Files = std::vector<fs::path>;

class WatchedFiles : public testing::Test {
protected:
    WatchedFiles()
    {
        folder_.write("a.c", "first");
        folder_.write("b.c", "other");
        const auto later = fs::file_time_type::clock::now() + std::chrono::seconds(1);
        watcher_.watch({folder_ / "a.c", folder_ / "b.c"}, later);
    }
    // What changes within the time that a look takes to come round, and a little more.
    Files changes(double seconds = 2)
    {
        const auto start = FileWatcher::Clock::now();
        Files changed;
        while (changed.empty() &&
               std::chrono::duration<double>(FileWatcher::Clock::now() - start).count() < seconds) {
            watcher_.wait(0.05);
            changed = watcher_.changed();
        }
        return changed;
    }
    Files a() const { return {folder_ / "a.c"}; }

    TestFolder folder_;
    FileWatcher watcher_;
};

TEST_F(WatchedFiles, NothingHappensByItself) { EXPECT_EQ(changes(0.7), Files{}); }

TEST_F(WatchedFiles, SavedInPlace)
{
    folder_.write("a.c", "second");
    EXPECT_EQ(changes(), a());
    EXPECT_EQ(changes(0.7), Files{});
}

TEST_F(WatchedFiles, SavedAsAnotherFileThatIsRenamed)
{
    for (const char* text : {"second", "third"}) {
        fs::rename(folder_.write(".a.c.swp", text), folder_ / "a.c");
        EXPECT_EQ(changes(), a()) << text;
    }
}

TEST_F(WatchedFiles, GoneForAMomentIsNoChange)
{
    fs::rename(folder_ / "a.c", folder_ / "a.c~");
    EXPECT_EQ(changes(0.7), Files{});
    folder_.write("a.c", "second");
    EXPECT_EQ(changes(), a());
}

TEST_F(WatchedFiles, SavedUnchangedIsNoChange)
{
    folder_.write("a.c", "first");
    EXPECT_EQ(changes(0.7), Files{});
}

TEST_F(WatchedFiles, WrittenSinceItWasReadIsAChange)
{
    const auto read_at = fs::file_time_type::clock::now() - std::chrono::seconds(2);
    folder_.write("c.c", "while it was read");
    watcher_.watch({folder_ / "c.c"}, read_at);
    EXPECT_EQ(changes(), Files{folder_ / "c.c"});
}

}  // namespace
