// `diptych watch` as people meet it: a process with files, a keyboard and signals.
#include "tests/debugger/textured_scene.hpp"
#include "tests/host/commands/program.hpp"

#include "host/image/image.hpp"

#include <gtest/gtest.h>

#include <csignal>
#include <fcntl.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

using namespace diptych;

namespace {

// A running `diptych watch`, with a pipe for a keyboard.
class Watch {
public:
    Watch(const TestFolder& folder, std::vector<std::string> words) : log_(folder / "log.txt")
    {
        words.insert(words.begin(), {diptych_program(), "watch"});
        std::vector<char*> pointers;
        for (std::string& word : words) pointers.push_back(word.data());
        pointers.push_back(nullptr);
        int ends[2];
        if (pipe2(ends, O_CLOEXEC) != 0) throw std::runtime_error("no pipe");
        keyboard_ = ends[1];
        child_ = fork();
        if (child_ == 0) {
            const int log = open(log_.c_str(), O_CREAT | O_WRONLY | O_APPEND, 0600);
            dup2(ends[0], STDIN_FILENO);
            dup2(log, STDERR_FILENO);
            execv(pointers[0], pointers.data());
            _exit(127);
        }
        close(ends[0]);
    }
    ~Watch()
    {
        if (child_ > 0) {
            ::kill(child_, SIGKILL);
            waitpid(child_, nullptr, 0);
        }
        if (keyboard_ >= 0) close(keyboard_);
    }
    Watch(const Watch&) = delete;
    Watch& operator=(const Watch&) = delete;

    std::string log() const
    {
        std::ifstream in(log_, std::ios::binary);
        return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
    }
    // Until the program says so after what was waited for before.
    testing::AssertionResult says(const std::string& text)
    {
        for (int k = 0; k < 20000; ++k) {
            const std::string all = log();
            const size_t at = all.find(text, read_);
            if (at != std::string::npos) {
                read_ = at + text.size();
                return testing::AssertionSuccess();
            }
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
        }
        return testing::AssertionFailure() << "not said: " << text << "; but\n" << log();
    }
    void type(const std::string& text) const
    {
        EXPECT_EQ(write(keyboard_, text.data(), text.size()), ssize_t(text.size()));
    }
    void end_input()
    {
        close(keyboard_);
        keyboard_ = -1;
    }
    void send(int signal) const { ::kill(child_, signal); }
    int exit_code()
    {
        int status = 0;
        waitpid(child_, &status, 0);
        child_ = 0;
        return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    }

private:
    std::string log_;
    pid_t child_ = 0;
    int keyboard_ = -1;
    size_t read_ = 0;
};

class WatchCommandLine : public testing::Test {
protected:
    WatchCommandLine() { write_painted_scene(folder_); }
    std::vector<std::string> words(const std::string& picture, const std::string& samples,
                                   const std::vector<std::string>& more = {}) const
    {
        std::vector<std::string> all = {folder_ / "scene.gltf", "--samples", samples, "-o",
                                        folder_ / picture};
        all.insert(all.end(), painted_view.begin(), painted_view.end());
        all.insert(all.end(), more.begin(), more.end());
        return all;
    }
    std::vector<float> pixels(const std::string& picture) const
    {
        return image::beauty_of(image::read_picture(folder_ / picture)).pixels;
    }
    std::vector<float> rendered(const std::vector<std::string>& more,
                                const std::string& samples = "4") const
    {
        std::vector<std::string> all = words("fresh.exr", samples, more);
        all.insert(all.begin(), "render");
        const Outcome outcome = run_diptych(all, {.seconds = 200});
        EXPECT_EQ(outcome.exit_code, 0) << outcome.text();
        return pixels("fresh.exr");
    }
    TestFolder folder_;
};

TEST_F(WatchCommandLine, FollowsTheKeyboardAndEditors)
{
    Watch watch(folder_, words("out.exr", "4"));
    ASSERT_TRUE(watch.says("complete with 4 samples"));
    watch.type("paint.scale=[4\npaint.scale=3\n");
    ASSERT_TRUE(watch.says("not JSON"));
    ASSERT_TRUE(watch.says("paint.scale=3: nothing to compile; first new sample after"));
    ASSERT_TRUE(watch.says("complete with 4 samples"));
    EXPECT_EQ(pixels("out.exr"), rendered({"--set", "paint.scale=3"}));

    std::string source = painted_source;
    source.replace(source.find("sin("), 4, "sine(");
    std::filesystem::rename(folder_.write("paint.c.tmp", source), folder_ / "paint.c");
    ASSERT_TRUE(watch.says("paint.c:" + std::to_string(line_of(source, "sine(")) + ":"));
    ASSERT_TRUE(watch.says("not taken"));
    source.replace(source.find("sine("), 5, "cos(");
    std::filesystem::rename(folder_.write("paint.c.tmp", source), folder_ / "paint.c");
    ASSERT_TRUE(watch.says("paint.c: texture stage made anew; first new sample after"));
    ASSERT_TRUE(watch.says("complete with 4 samples"));
    EXPECT_EQ(pixels("out.exr"), rendered({"--set", "paint.scale=3"}));
    watch.type("quit\n");
    EXPECT_EQ(watch.exit_code(), 0);
}

// Each edit that the copy lacks is told, and the copy runs as it is.
TEST_F(WatchCommandLine, AnEditThatMakesAGeneratedCopyOldIsTold)
{
    const std::vector<std::string> copy = {"--backend", "twin", "--use-generated",
                                           folder_ / "code"};
    rendered({"--backend", "twin", "--generated-dir", folder_ / "code"});
    Watch watch(folder_, words("out.exr", "4", copy));
    ASSERT_TRUE(watch.says("complete with 4 samples"));
    const std::vector<float> first = pixels("out.exr");
    std::string edited = painted_source;
    edited.replace(edited.find("0.25f"), 5, "0.5f");
    const std::string notice =
        "watch: notice: --use-generated: " + (folder_ / "code/functions.hpp") +
        ": made before the last edit of " + (folder_ / "paint.c");
    EXPECT_EQ(watch.log().find("made before"), std::string::npos) << watch.log();
    for (int k = 0; k < 2; ++k) {
        folder_.write("paint.c", edited);
        ASSERT_TRUE(watch.says(notice));
        ASSERT_TRUE(watch.says("complete with 4 samples"));
        EXPECT_EQ(pixels("out.exr"), first);
        folder_.write("paint.c", painted_source);
        ASSERT_TRUE(watch.says("paint.c: texture stage made anew"));
        ASSERT_TRUE(watch.says("complete with 4 samples"));
    }
    folder_.write("paint.c", edited + "// more\n");
    ASSERT_TRUE(watch.says(notice));
    watch.type("quit\n");
    EXPECT_EQ(watch.exit_code(), 0);

    // and from the first picture on
    std::filesystem::remove(folder_ / "log.txt");
    Watch again(folder_, words("out.exr", "4", copy));
    ASSERT_TRUE(again.says(notice));
}

TEST_F(WatchCommandLine, TheEndOfTheInputEndsNothingAndInterruptsWriteThePicture)
{
    Watch watch(folder_, words("out.png", "1000000"));
    watch.end_input();
    ASSERT_TRUE(watch.says("quit ends"));
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    watch.send(SIGINT);
    EXPECT_EQ(watch.exit_code(), 130) << watch.log();
    EXPECT_EQ(image::read_picture(folder_ / "out.png").width, 40);
}

// The picture is that of a render with the same target, before and after an edit.
TEST_F(WatchCommandLine, RendersUntilTheErrorIsSmallEnough)
{
    Watch watch(folder_, words("out.exr", "512", {"--error", "2"}));
    ASSERT_TRUE(watch.says("asked for 2 JND, predicted"));
    ASSERT_TRUE(watch.says("complete, written"));
    watch.type("paint.scale=3\n");
    ASSERT_TRUE(watch.says("nothing to compile"));
    ASSERT_TRUE(watch.says("complete, written"));
    watch.type("quit\n");
    EXPECT_EQ(watch.exit_code(), 0);
    EXPECT_EQ(pixels("out.exr"), rendered({"--set", "paint.scale=3", "--error", "2"}, "512"));
}

TEST_F(WatchCommandLine, EndsItsPicturesWhenTheTimeIsOver)
{
    Watch watch(folder_, words("out.exr", "1000000", {"--time", "0.2s"}));
    ASSERT_TRUE(watch.says("the time is over"));
    ASSERT_TRUE(watch.says("complete, written"));
    watch.type("paint.scale=3\n");
    ASSERT_TRUE(watch.says("the time is over"));
    watch.type("quit\n");
    EXPECT_EQ(watch.exit_code(), 0);
}

TEST_F(WatchCommandLine, WrongWordsAreRefused)
{
    EXPECT_EQ(run_diptych({"watch"}).exit_code, 2);
    const Outcome nothing = run_diptych({"watch", folder_ / "absent.gltf"});
    EXPECT_EQ(nothing.exit_code, 2);
    EXPECT_NE(nothing.err.find("absent.gltf"), std::string::npos) << nothing.text();
    EXPECT_NE(run_diptych({"watch", "--help"}).out.find("Exit codes"), std::string::npos);
}

}  // namespace
