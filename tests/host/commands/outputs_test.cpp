// Where a user may point outputs: through links, into pipes and devices; and what is refused.
#include "tests/host/commands/program.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <unistd.h>

namespace fs = std::filesystem;

namespace {

std::string bytes_of_file(const std::string& path)
{
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

void expect_refusal(const Outcome& outcome, const std::string& path)
{
    EXPECT_EQ(outcome.exit_code, 2) << outcome.text();
    ASSERT_EQ(outcome.err_lines().size(), 1u) << outcome.text();
    EXPECT_EQ(outcome.err_lines()[0],
              "diptych: " + path +
                  ": is a pipe, and only a file can be replaced whole; name a file");
}

// A pipe that is open for reading, and holds what a program writes until it is asked for.
class Pipe {
public:
    explicit Pipe(const std::string& path)
    {
        EXPECT_EQ(mkfifo(path.c_str(), 0600), 0);
        file_ = open(path.c_str(), O_RDONLY | O_NONBLOCK);
    }
    ~Pipe() { close(file_); }
    Pipe(const Pipe&) = delete;
    Pipe& operator=(const Pipe&) = delete;

    std::string text() const
    {
        std::string all(65536, '\0');
        const ssize_t got = read(file_, all.data(), all.size());
        all.resize(size_t(std::max<ssize_t>(got, 0)));
        return all;
    }

private:
    int file_;
};

class Outputs : public testing::Test {
protected:
    Outcome render(std::vector<std::string> more, const std::string& samples = "16")
    {
        more.insert(more.begin(), {"render", "--size", "32x24", "--samples", samples, "--env",
                                   "none", "--reproducible"});
        return run_diptych(more);
    }

    TestFolder folder_;
    std::string picture_ = folder_ / "a.exr";
};

TEST_F(Outputs, AReportGoesStraightIntoAPipeOrADevice)
{
    const std::string report = folder_ / "report";
    const Pipe pipe(report);
    const Outcome piped = render({"--quiet", "-o", picture_, "--json", report});
    const std::string text = pipe.text();
    EXPECT_EQ(piped.exit_code, 0) << piped.text();
    EXPECT_TRUE(text.starts_with("{") && text.ends_with("}\n")) << text;
    EXPECT_TRUE(fs::is_fifo(report));

    // a link of our own, as /dev/stdout is one, which a program at fault may replace
    const std::string standard_output = folder_ / "stdout";
    fs::create_symlink("/proc/self/fd/1", standard_output);
    const Outcome printed = render({"--quiet", "-o", picture_, "--json", standard_output});
    EXPECT_TRUE(fs::is_symlink(standard_output));
    EXPECT_EQ(printed.exit_code, 0) << printed.text();
    EXPECT_TRUE(printed.out.starts_with("{")) << printed.out;

    const std::string node = folder_ / "null";
    if (mknod(node.c_str(), S_IFCHR | 0666, makedev(1, 3)) != 0)
        GTEST_SKIP() << "device nodes may not be made here";
    EXPECT_EQ(render({"--quiet", "-o", picture_, "--json", node}).exit_code, 0);
    EXPECT_TRUE(fs::is_character_file(node));
    EXPECT_EQ(folder_.files(), (std::vector<std::string>{"a.exr", "null", "report", "stdout"}));
}

TEST_F(Outputs, PicturesAndCheckpointsAreRefusedWhereTheyCannotBeReplaced)
{
    const std::string picture = folder_ / "pipe.png", checkpoint = folder_ / "pipe.checkpoint";
    const Pipe first(picture), second(checkpoint);
    expect_refusal(render({"-o", picture}), picture);
    expect_refusal(render({"-o", picture_, "--checkpoint", checkpoint}), checkpoint);
    const std::string slice = folder_ / "slice.checkpoint";
    ASSERT_EQ(render({"--quiet", "-o", picture_, "--checkpoint", slice}).exit_code, 0);
    for (const std::string& output : {picture, checkpoint})
        expect_refusal(run_diptych({"merge", slice, "-o", output}), output);
    expect_refusal(run_diptych({"compare", picture_, picture_, "-o", picture}), picture);
    EXPECT_EQ(folder_.files(), (std::vector<std::string>{"a.exr", "pipe.checkpoint", "pipe.png",
                                                         "slice.checkpoint"}));
}

// Before an hour of measurements.
TEST_F(Outputs, AStudysPicturesAreTriedFirst)
{
    const std::string picture = folder_ / "s-rust-cpu.png";
    const Pipe pipe(picture);
    expect_refusal(run_diptych({"study", "textures", "--backends", "cpu", "-o", folder_ / "s"}),
                   picture);
    EXPECT_EQ(folder_.files(), std::vector<std::string>{"s-rust-cpu.png"});
}

TEST_F(Outputs, LinksStayAndLeadToTheNewFiles)
{
    const std::string far = folder_ / "far";
    fs::create_directory(far);
    const std::vector<std::string> names = {"a.checkpoint", "a.json", "a.png"};
    for (const std::string& name : names) fs::create_symlink("far/" + name, folder_ / name);
    const auto render_all = [&](const std::string& samples) {
        return render({"--quiet", "-o", folder_ / "a.png", "--json", folder_ / "a.json",
                       "--checkpoint", folder_ / "a.checkpoint", "--restart"},
                      samples);
    };
    std::map<std::string, std::string> before;
    for (const char* samples : {"16", "32"}) {
        const Outcome outcome = render_all(samples);
        ASSERT_EQ(outcome.exit_code, 0) << outcome.text();
        for (const std::string& name : names) {
            EXPECT_TRUE(fs::is_symlink(folder_ / name)) << name;
            const std::string now = bytes_of_file(far + "/" + name);
            EXPECT_FALSE(now.empty()) << name;
            EXPECT_NE(now, before[name]) << name;
            before[name] = now;
        }
    }
    EXPECT_EQ(folder_.files(),
              (std::vector<std::string>{"a.checkpoint", "a.json", "a.png", "far"}));
    EXPECT_EQ(std::distance(fs::directory_iterator(far), {}), 3) << "nothing is left beside them";

    const Outcome twice =
        render({"-o", folder_ / "a.png", "-o", far + "/a.png"});  // one file by two names
    EXPECT_EQ(twice.exit_code, 2) << twice.text();
    EXPECT_NE(twice.err.find("is named for two outputs"), std::string::npos) << twice.err;
}

TEST_F(Outputs, ComparisonsGoIntoPipes)
{
    ASSERT_EQ(render({"--quiet", "-o", picture_}).exit_code, 0);
    const std::string report = folder_ / "report";
    const Pipe pipe(report);
    const Outcome outcome = run_diptych({"compare", picture_, picture_, "--json", report});
    const std::string text = pipe.text();
    EXPECT_EQ(outcome.exit_code, 0) << outcome.text();
    EXPECT_TRUE(text.starts_with("{")) << text;
    EXPECT_TRUE(fs::is_fifo(report));
}

}  // namespace
