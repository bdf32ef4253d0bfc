// What a viewer receives, read by a server that knows the protocol.
#include "host/image/tev_client.hpp"
#include "tests/host/image/tev_server.hpp"

#include <chrono>
#include <numeric>
#include <stdexcept>
#include <thread>

namespace {

using diptych::image::TevClient;

TEST(TevClient, SendsThePictureInPackets)
{
    const int width = 5, height = 130;
    std::vector<float> rgba(width * height * 4);
    std::iota(rgba.begin(), rgba.end(), 0.5f);
    TevServer server;
    std::string bytes;
    std::thread receiving([&] { bytes = server.receive(); });
    {
        TevClient client(server.address(), "a picture", width, height);
        client.show(rgba);
        EXPECT_TRUE(client.finish());
        EXPECT_TRUE(client.is_idle());
    }
    receiving.join();

    const TevPicture received = parse_tev(bytes);
    EXPECT_EQ(received.name, "a picture");
    EXPECT_EQ(received.width, width);
    EXPECT_EQ(received.height, height);
    EXPECT_EQ(received.updates, 3) << "of 64 rows at most";
    EXPECT_EQ(received.rgba, rgba);
}

// Also where it was given when the one before was half-way.
TEST(TevClient, EndsWithTheLastPicture)
{
    const int width = 1000, height = 1000;
    std::vector<float> rgba(width * height * 4, 1.0f);
    TevServer server;
    std::string bytes;
    std::thread receiving;
    {
        TevClient client(server.address(), "x", width, height);
        client.show(rgba);
        EXPECT_TRUE(client.go_on());
        EXPECT_FALSE(client.is_idle()) << "no one reads yet";
        receiving = std::thread([&] { bytes = server.receive(); });
        rgba.assign(rgba.size(), 2.0f);
        client.show(rgba);
        EXPECT_TRUE(client.finish());
    }
    receiving.join();
    EXPECT_EQ(parse_tev(bytes).rgba, rgba);
}

TEST(TevClient, SaysWhenNoOneAnswers)
{
    std::string address;
    {
        const TevServer gone;
        address = gone.address();
    }
    EXPECT_THROW(TevClient(address, "x", 1, 1), std::runtime_error);
    EXPECT_THROW(TevClient("no such host.invalid:1", "x", 1, 1), std::runtime_error);
}

TEST(TevClient, GoesOnWithoutAViewerThatLeft)
{
    TevServer server;
    std::thread receiving([&] { server.receive(1); });
    TevClient client(server.address(), "x", 64, 64);
    receiving.join();
    const std::vector<float> rgba(64 * 64 * 4);
    bool is_there = true;
    for (int k = 0; is_there && k < 1000; ++k) {
        client.show(rgba);
        is_there = client.finish();
    }
    EXPECT_FALSE(is_there);
    EXPECT_FALSE(client.go_on());
}

// More than the system keeps for a viewer that does not read.
TEST(TevClient, LetsGoOfAViewerThatTakesNothing)
{
    const TevServer server;
    const std::vector<float> rgba(1000 * 1000 * 4);
    TevClient at_the_end(server.address(), "x", 1000, 1000),
        meanwhile(server.address(), "y", 1000, 1000);
    at_the_end.show(rgba);
    EXPECT_FALSE(at_the_end.finish());
    EXPECT_FALSE(at_the_end.go_on());
    meanwhile.show(rgba);
    EXPECT_TRUE(meanwhile.go_on()) << "it may only be slow";
    while (meanwhile.go_on()) std::this_thread::sleep_for(std::chrono::milliseconds(10));
    EXPECT_FALSE(meanwhile.is_idle());
}

}  // namespace
