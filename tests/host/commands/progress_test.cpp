// What is seen of a render in progress: in a viewer, and in the files.
#include "host/image/image.hpp"
#include "tests/host/commands/program.hpp"
#include "tests/host/image/tev_server.hpp"

#include <atomic>
#include <poll.h>
#include <set>
#include <sys/inotify.h>
#include <thread>

using namespace diptych;

namespace {

std::vector<float> beauty_in(const std::string& path)
{
    return image::beauty_of(image::read_picture(path)).pixels;
}

class Progress : public testing::Test {
protected:
    Outcome render(std::vector<std::string> more)
    {
        more.insert(more.begin(), {"render", "--env", "none", "--reproducible", "-o", picture_});
        return run_diptych(more);
    }

    TestFolder folder_;
    std::string picture_ = folder_ / "a.exr";
};

TEST_F(Progress, AViewerReceivesThePictureThatIsWritten)
{
    TevServer server;
    std::string bytes;
    std::thread receiving([&] { bytes = server.receive(); });
    const Outcome outcome = render(
        {"--size", "96x54", "--samples", "16", "--quiet", "--preview", "tev:" + server.address()});
    receiving.join();
    ASSERT_EQ(outcome.exit_code, 0) << outcome.text();
    EXPECT_EQ(outcome.err.find("viewer"), std::string::npos) << outcome.err;
    const TevPicture shown = parse_tev(bytes);
    EXPECT_EQ(shown.name, picture_);
    EXPECT_EQ(shown.width, 96);
    EXPECT_EQ(shown.height, 54);
    EXPECT_GE(shown.updates, 2) << "in progress, and at the end";
    EXPECT_EQ(shown.rgba, beauty_in(picture_));
}

// Two pictures are more than the system keeps for who does not read.
TEST_F(Progress, AViewerThatHangsIsLetGo)
{
    const TevServer server;
    const Outcome outcome = render(
        {"--size", "640x360", "--samples", "1", "--quiet", "--preview", "tev:" + server.address()});
    EXPECT_EQ(outcome.exit_code, 0) << outcome.text();
    EXPECT_EQ(outcome.err_lines(),
              std::vector<std::string>{"notice: the viewer has gone; rendering goes on"});
    EXPECT_EQ(beauty_in(picture_).size(), 640u * 360 * 4);
}

// Reads a picture whenever another is put in its place.
class Onlooker {
public:
    Onlooker(const TestFolder& folder, const std::string& name)
        : path_(folder / name), name_(name), events_(inotify_init1(IN_CLOEXEC | IN_NONBLOCK))
    {
        EXPECT_GE(inotify_add_watch(events_, folder.path().c_str(), IN_MOVED_TO), 0);
        looking_ = std::thread([this] { look(); });
    }
    ~Onlooker()
    {
        finish();
        close(events_);
    }

    void finish()
    {
        is_over_ = true;
        if (looking_.joinable()) looking_.join();
    }
    int replaced() const { return replaced_; }
    const std::set<std::vector<float>>& seen() const { return seen_; }

private:
    void look()
    {
        while (take_events() || !is_over_) {
            pollfd event = {events_, POLLIN, 0};
            poll(&event, 1, 10);
        }
    }

    bool take_events()
    {
        alignas(inotify_event) char buffer[4096];
        const ssize_t bytes = read(events_, buffer, sizeof buffer);
        for (ssize_t at = 0; at < bytes;) {
            const auto* event = reinterpret_cast<const inotify_event*>(buffer + at);
            replaced_ += event->name == name_;
            at += ssize_t(sizeof *event + event->len);
        }
        if (bytes > 0) seen_.insert(beauty_in(path_));  // throws where it is not whole
        return bytes > 0;
    }

    std::string path_, name_;
    int events_;
    int replaced_ = 0;
    std::set<std::vector<float>> seen_;
    std::atomic<bool> is_over_ = false;
    std::thread looking_;
};

TEST_F(Progress, TheFileIsReplacedWhileTheRenderGoesOn)
{
    Onlooker onlooker(folder_, "a.exr");
    const Outcome outcome = render({"--size", "96x54", "--time", "2s", "--memory", "1M",
                                    "--threads", "1", "--refresh", "0.1s", "--quiet"});
    onlooker.finish();
    ASSERT_EQ(outcome.exit_code, 0) << outcome.text();
    EXPECT_GE(onlooker.replaced(), 4);
    EXPECT_GE(onlooker.seen().size(), 3u) << "each with more samples than the one before";
    EXPECT_TRUE(onlooker.seen().contains(beauty_in(picture_)));
    EXPECT_EQ(folder_.files(), std::vector<std::string>{"a.exr"});
}

}  // namespace
