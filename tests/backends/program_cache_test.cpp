// The cache keeps what it is given, refuses what was damaged, and stands several writers.
#include "backends/program_cache.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <thread>
#include <vector>

using diptych::ProgramCache;
namespace fs = std::filesystem;

namespace {

class ProgramCacheTest : public testing::Test {
protected:
    ProgramCacheTest()
        : folder_(fs::temp_directory_path() /
                  ("diptych-cache-" +
                   std::to_string(testing::UnitTest::GetInstance()->random_seed()) +
                   testing::UnitTest::GetInstance()->current_test_info()->name()))
    {
        fs::remove_all(folder_);
    }
    ~ProgramCacheTest() override { fs::remove_all(folder_); }

    fs::path folder_;
};

TEST_F(ProgramCacheTest, GivesBackWhatWasStored)
{
    const std::string binary("\0\1binary\xff\n", 10);
    ProgramCache cache(folder_);
    EXPECT_FALSE(cache.load("key"));
    cache.store("key", binary);
    EXPECT_EQ(cache.load("key"), binary);
    EXPECT_EQ(ProgramCache(folder_).load("key"), binary);
    EXPECT_FALSE(cache.load("other"));
    EXPECT_EQ(cache.notice(), "");
}

TEST_F(ProgramCacheTest, RefusesEntriesThatWereDamaged)
{
    ProgramCache cache(folder_);
    cache.store("key", std::string(1000, 'x'));
    fs::resize_file(folder_ / "key", 700);
    EXPECT_FALSE(cache.load("key"));
    fs::resize_file(folder_ / "key", 3);
    EXPECT_FALSE(cache.load("key"));
    fs::resize_file(folder_ / "key", 0);
    EXPECT_FALSE(cache.load("key"));
    cache.store("key", std::string(1000, 'x'));
    std::fstream(folder_ / "key", std::ios::in | std::ios::out | std::ios::binary)
        .seekp(500)
        .put('y');
    EXPECT_FALSE(cache.load("key"));
    cache.store("key", "new");
    EXPECT_EQ(cache.load("key"), "new");
}

TEST_F(ProgramCacheTest, IsReadWholeWhileOthersWrite)
{
    std::vector<std::thread> writers;
    for (int w = 0; w < 4; ++w)
        writers.emplace_back([&, w] {
            ProgramCache cache(folder_);
            for (int k = 0; k < 50; ++k) cache.store("key", std::string(20000, char('a' + w)));
        });
    ProgramCache cache(folder_);
    int read = 0;
    for (int k = 0; k < 500; ++k)
        if (const auto entry = cache.load("key")) {
            ++read;
            EXPECT_EQ(*entry, std::string(20000, entry->front()));
        }
    for (std::thread& writer : writers) writer.join();
    EXPECT_TRUE(cache.load("key"));
    int files = 0;
    for ([[maybe_unused]] const auto& entry : fs::directory_iterator(folder_)) ++files;
    EXPECT_EQ(files, 1) << "temporary files were left behind";
}

TEST_F(ProgramCacheTest, GoesWithoutAFolderItCannotMake)
{
    std::ofstream(folder_) << "a file where the folder should be";
    ProgramCache cache(folder_ / "inside");
    EXPECT_NE(cache.notice(), "");
    cache.store("key", "binary");
    EXPECT_FALSE(cache.load("key"));
}

}  // namespace
