// What is seen of a render in progress.
#include "host/image/image.hpp"
#include "tests/host/commands/program.hpp"
#include "tests/host/image/tev_server.hpp"

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

}  // namespace
