// What is put in the place of what: links stay and lead to the new version, and nothing but a file
// is ever replaced.
#include "host/image/image.hpp"
#include "host/image/whole_file.hpp"
#include "tests/host/image/scratch_folder.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>

#include <stdexcept>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <thread>

using namespace diptych::image;
namespace fs = std::filesystem;

namespace {

template<class Action>
std::string error_of(Action&& action)
{
    try {
        action();
    } catch (const std::runtime_error& error) {
        return error.what();
    }
    return {};
}

void write_with(const std::string& path, Survives survives)
{
    WholeFile file(path, survives);
    file.write("new", 3);
    file.put_in_place();
}

class WholeFileTest : public testing::Test {
protected:
    ScratchFolder folder_;
};

TEST_F(WholeFileTest, ReplacesWhatALinkLeadsToAndKeepsTheLink)
{
    fs::create_directories(folder_ / "far");
    for (const Survives survives : {Survives::Program, Survives::Machine}) {
        put_bytes(folder_ / "far/file", "old");
        fs::create_symlink("far/file", folder_ / "near");     // relative to the link's folder
        fs::create_symlink(folder_ / "near", folder_ / "l");  // by way of another
        write_with(folder_ / "l", survives);
        EXPECT_TRUE(fs::is_symlink(folder_ / "l"));
        EXPECT_TRUE(fs::is_symlink(folder_ / "near"));
        EXPECT_FALSE(fs::is_symlink(folder_ / "far/file"));
        EXPECT_EQ(bytes_of(folder_ / "far/file"), "new");
        EXPECT_EQ(fs::canonical(file_behind(folder_ / "l")), fs::canonical(folder_ / "far/file"));
        fs::remove(folder_ / "l");
        fs::remove(folder_ / "near");
    }
    EXPECT_EQ(folder_.files(), 1);
}

TEST_F(WholeFileTest, MakesTheFileThatALinkLacks)
{
    fs::create_symlink("later", folder_ / "link");
    write_with(folder_ / "link", Survives::Program);
    EXPECT_TRUE(fs::is_symlink(folder_ / "link"));
    EXPECT_EQ(bytes_of(folder_ / "later"), "new");

    fs::create_symlink("no/such/folder", folder_ / "astray");
    const std::string error = error_of([&] { write_with(folder_ / "astray", Survives::Program); });
    EXPECT_NE(error.find("astray"), std::string::npos) << error;
    EXPECT_NE(error.find("no/such/folder"), std::string::npos) << "where it leads: " << error;
    EXPECT_NE(error.find("check that its folder exists"), std::string::npos) << error;
}

TEST_F(WholeFileTest, RefusesLinksInACircle)
{
    fs::create_symlink("b", folder_ / "a");
    fs::create_symlink("a", folder_ / "b");
    for (const auto& error : {error_of([&] { write_with(folder_ / "a", Survives::Program); }),
                              error_of([&] { write_text(folder_ / "a", "x"); }),
                              error_of([&] { check_text_writable(folder_ / "a"); })})
        EXPECT_NE(error.find("links in a circle"), std::string::npos) << error;
    EXPECT_EQ(folder_.files(), 2);
}

TEST_F(WholeFileTest, RefusesToReplaceWhatIsNoFile)
{
    const std::string pipe = folder_ / "pipe.png";
    ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
    fs::create_symlink("pipe.png", folder_ / "link.png");
    for (const std::string& path : {pipe, folder_ / "link.png"}) {
        for (const auto& error : {error_of([&] { write_with(path, Survives::Program); }),
                                  error_of([&] { write_with(path, Survives::Machine); }),
                                  error_of([&] { write_file_whole(path, "x"); }),
                                  error_of([&] { check_file_writable(path); }),
                                  error_of([&] { check_writable(path); })})
            EXPECT_EQ(error, path + ": is a pipe, and only a file can be replaced whole; "
                                    "name a file");
    }
    EXPECT_TRUE(fs::is_fifo(pipe));
    EXPECT_EQ(folder_.files(), 2);
}

TEST_F(WholeFileTest, WritesTextsStraightIntoAPipe)
{
    const std::string pipe = folder_ / "pipe";
    ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
    check_text_writable(pipe);  // does not wait for the reader
    const std::string text(200000, 'x');
    std::string read;
    std::thread reader([&] { read = bytes_of(pipe); });
    write_text(pipe, text);
    reader.join();
    EXPECT_EQ(read, text);
    EXPECT_TRUE(fs::is_fifo(pipe));
    EXPECT_EQ(folder_.files(), 1);
}

TEST_F(WholeFileTest, WritesTextsStraightIntoADevice)
{
    const std::string node = folder_ / "null";
    if (mknod(node.c_str(), S_IFCHR | 0666, makedev(1, 3)) != 0)
        GTEST_SKIP() << "device nodes may not be made here";
    check_text_writable(node);
    EXPECT_EQ(error_of([&] { write_text(node, "text"); }), "");
    EXPECT_NE(error_of([&] { write_file_whole(node, "x"); }).find("is a device"),
              std::string::npos);
    EXPECT_TRUE(fs::is_character_file(node));
    EXPECT_EQ(folder_.files(), 1);
}

// As /dev/stdout is: what a shell opened with > or >> goes on where it stands.
TEST_F(WholeFileTest, WritesTextsStraightIntoAnOpenFile)
{
    const std::string path = folder_ / "out";
    const int file = open(path.c_str(), O_WRONLY | O_CREAT, 0600);
    ASSERT_GE(file, 0);
    ASSERT_EQ(write(file, "before ", 7), 7);
    const std::string name = "/dev/fd/" + std::to_string(file);
    check_text_writable(name);
    write_text(name, "text ");
    ASSERT_EQ(write(file, "after", 5), 5);
    close(file);
    EXPECT_EQ(bytes_of(path), "before text after");
    EXPECT_EQ(folder_.files(), 1);
}

TEST_F(WholeFileTest, WritesTextsWholeWhereAFileIsNamed)
{
    put_bytes(folder_ / "file", "a longer old text");
    write_text(folder_ / "file", "text");
    EXPECT_EQ(bytes_of(folder_ / "file"), "text");
    EXPECT_EQ(folder_.files(), 1);
    EXPECT_NE(error_of([&] {
                  check_text_writable(folder_ / "no/such/file");
              }).find("check that its folder exists"),
              std::string::npos);
    fs::create_directory(folder_ / "folder");
    EXPECT_NE(error_of([&] { write_text(folder_ / "folder", "x"); }).find("name a file"),
              std::string::npos);
}

}  // namespace
