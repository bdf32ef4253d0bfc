// A checkpoint file is read as it was written, or refused in words; and whenever its writer dies, a
// whole one is there.
#include "tests/host/commands/program.hpp"
#include "tests/host/render/rendered_slice.hpp"

#include <csignal>
#include <fstream>
#include <random>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

namespace {

using namespace slices;

std::string bytes_of_file(const std::string& path)
{
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

class CheckpointFile : public testing::Test {
protected:
    std::string refusal_of(const std::string& bytes)
    {
        const std::string path = folder_.write("bad", bytes);
        const std::string error = error_of([&] { read_checkpoint(path); });
        EXPECT_EQ(error.find(path + ": "), 0u) << error;
        EXPECT_NE(error.find("; "), std::string::npos) << "says what to do: " << error;
        EXPECT_EQ(error.find('\n'), std::string::npos) << error;
        return error;
    }

    TestFolder folder_;
    std::string path_ = folder_ / "a.checkpoint";
};

TEST_F(CheckpointFile, ComesBackAsItWasWritten)
{
    Checkpoint out = rendered({.end = 40, .dispatches = 3});
    out.head.seconds = 1.5;
    out.head.rays = 1ull << 40;
    out.head.planned = 512;
    write(path_, out);
    const Checkpoint in = read_checkpoint(path_);
    EXPECT_EQ(difference_between(in.head.subject, out.head.subject), "");
    EXPECT_EQ(in.head.backends, out.head.backends);
    EXPECT_EQ(in.head.seconds, 1.5);
    EXPECT_EQ(in.head.rays, 1ull << 40);
    EXPECT_EQ(in.head.planned, 512);
    const CheckpointHead head = read_checkpoint_head(path_);
    EXPECT_EQ(difference_between(head.subject, out.head.subject), "");
    EXPECT_EQ(fraction_done(head), fraction_done(out.head));
    EXPECT_EQ(head.planned, 512);
    EXPECT_EQ(fraction_done(path_), fraction_done(out.head));
    EXPECT_GT(fraction_done(path_), 0);
    EXPECT_LT(fraction_done(path_), 1);
    ASSERT_EQ(in.head.slices.size(), 1u);
    ASSERT_EQ(in.head.slices[0].schedule.blocks.size(), out.head.slices[0].schedule.blocks.size());
    for (size_t k = 0; k < in.head.slices[0].schedule.blocks.size(); ++k) {
        EXPECT_EQ(in.head.slices[0].schedule.blocks[k].quanta,
                  out.head.slices[0].schedule.blocks[k].quanta);
        EXPECT_EQ(in.head.slices[0].schedule.blocks[k].target,
                  out.head.slices[0].schedule.blocks[k].target);
    }
    expect_same_picture(in.film, out.film);
    EXPECT_EQ(folder_.files(), std::vector<std::string>{"a.checkpoint"});
}

TEST_F(CheckpointFile, IsRefusedWhenCutShortAnywhere)
{
    write(path_, rendered({.end = 16}));
    const std::string whole = bytes_of_file(path_);
    for (size_t length = 0; length < whole.size(); length += length < 1500 ? 1 : 997)
        refusal_of(whole.substr(0, length));
    refusal_of(whole.substr(0, whole.size() - 1));
    refusal_of(whole + "x");
}

TEST_F(CheckpointFile, IsRefusedWhenAnyByteIsWrong)
{
    write(path_, rendered({.end = 16}));
    const std::string whole = bytes_of_file(path_);
    std::mt19937 random(1);
    for (size_t at = 0; at < whole.size(); at += at < 1500 ? 1 : 1 + random() % 2000) {
        std::string bytes = whole;
        bytes[at] = char(bytes[at] ^ 1 << random() % 8);
        const std::string error = refusal_of(bytes);
        if (at >= 8 && at < 12)
            EXPECT_NE(error.find("format version"), std::string::npos) << error;
        else
            EXPECT_TRUE(error.find("corrupt") != std::string::npos ||
                        error.find("cut short") != std::string::npos)
                << at << ": " << error;
    }
}

TEST_F(CheckpointFile, ThatIsNoneIsRefused)
{
    EXPECT_NE(refusal_of("a letter").find("is no checkpoint"), std::string::npos);
    EXPECT_NE(refusal_of(std::string(1000, '\0')).find("is no checkpoint"), std::string::npos);
    EXPECT_NE(error_of([&] { read_checkpoint(folder_ / "none"); }).find("no such file"),
              std::string::npos);
}

TEST_F(CheckpointFile, IsWholeWheneverItsWriterIsKilled)
{
    const Checkpoint checkpoint = rendered({.end = 32});
    write(path_, checkpoint);
    std::mt19937 random(7);
    int unfinished = 0;
    for (int kill_number = 0; kill_number < 50; ++kill_number) {
        const pid_t child = fork();
        ASSERT_GE(child, 0);
        if (child == 0)
            for (;;) write(path_, checkpoint);
        std::this_thread::sleep_for(std::chrono::microseconds(random() % 20000));
        kill(child, SIGKILL);
        waitpid(child, nullptr, 0);
        expect_same_picture(read_checkpoint(path_).film, checkpoint.film);
        unfinished += folder_.files().size() > 1;
    }
    EXPECT_GT(unfinished, 0) << "no writer was killed while it wrote";
    write(path_, checkpoint);
    EXPECT_EQ(folder_.files(), std::vector<std::string>{"a.checkpoint"}) << "leftovers are reused";
}

TEST_F(CheckpointFile, IsKeptWhenTheNewOneCannotBeWritten)
{
    write(path_, rendered({.end = 16}));
    const std::string before = bytes_of_file(path_);
    {
        SafeFile file(path_);
        file.write("half", 4);
    }
    EXPECT_EQ(bytes_of_file(path_), before);
    EXPECT_EQ(folder_.files().size(), 1u);
    EXPECT_NE(error_of([&] { SafeFile(folder_ / "no/such/folder"); }).find("check that its folder"),
              std::string::npos);
    EXPECT_NE(error_of([&] { SafeFile(folder_.path().string()); }).find("name a file"),
              std::string::npos);
}

TEST_F(CheckpointFile, IsLockedForOneProcess)
{
    {
        const FileLock lock(path_);
        EXPECT_NE(error_of([&] { FileLock again(path_); }).find("another process"),
                  std::string::npos);
        const std::string link = folder_ / "link";
        std::filesystem::create_symlink(path_, link);
        EXPECT_NE(error_of([&] { FileLock again(link); }).find("another process"),
                  std::string::npos)
            << "by another name";
        std::filesystem::remove(link);
    }
    EXPECT_EQ(error_of([&] { FileLock again(path_); }), "");
    EXPECT_TRUE(folder_.files().empty());
}

}  // namespace
