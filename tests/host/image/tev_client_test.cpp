// What a viewer receives, read by a server that knows the protocol.
#include "host/image/tev_client.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <netinet/in.h>
#include <numeric>
#include <stdexcept>
#include <string>
#include <sys/socket.h>
#include <thread>
#include <unistd.h>
#include <vector>

namespace {

using diptych::image::TevClient;

// Listens at a free port, and keeps what one client sends.
class Server {
public:
    Server() : listening_(socket(AF_INET, SOCK_STREAM, 0))
    {
        sockaddr_in address = {};
        address.sin_family = AF_INET;
        address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        socklen_t length = sizeof address;
        EXPECT_EQ(bind(listening_, reinterpret_cast<sockaddr*>(&address), length), 0);
        EXPECT_EQ(listen(listening_, 1), 0);
        getsockname(listening_, reinterpret_cast<sockaddr*>(&address), &length);
        port_ = ntohs(address.sin_port);
    }
    ~Server() { close(listening_); }

    std::string address() const { return "127.0.0.1:" + std::to_string(port_); }

    // Until the client closes, or after `most` bytes.
    std::string receive(size_t most = SIZE_MAX)
    {
        const int client = accept(listening_, nullptr, nullptr);
        std::string all;
        char buffer[4096];
        for (ssize_t n = 0; all.size() < most && (n = read(client, buffer, sizeof buffer)) > 0;)
            all.append(buffer, size_t(n));
        close(client);
        return all;
    }

private:
    int listening_;
    int port_ = 0;
};

class Reader {
public:
    explicit Reader(const std::string& bytes) : bytes_(bytes) {}

    template<class Value>
    Value take()
    {
        Value value{};
        EXPECT_LE(at_ + sizeof value, bytes_.size());
        std::memcpy(&value, bytes_.data() + at_, sizeof value);
        at_ += sizeof value;
        return value;
    }
    std::string text()
    {
        const std::string found = bytes_.c_str() + at_;
        at_ += found.size() + 1;
        return found;
    }
    size_t at() const { return at_; }
    bool is_at_end() const { return at_ == bytes_.size(); }

private:
    const std::string& bytes_;
    size_t at_ = 0;
};

TEST(TevClient, SendsThePictureInPackets)
{
    const int width = 5, height = 130;
    std::vector<float> rgba(width * height * 4);
    std::iota(rgba.begin(), rgba.end(), 0.5f);
    Server server;
    std::string bytes;
    std::thread receiving([&] { bytes = server.receive(); });
    {
        TevClient client(server.address(), "a picture", width, height);
        EXPECT_TRUE(client.update(rgba));
    }
    receiving.join();

    Reader in(bytes);
    EXPECT_EQ(in.take<std::uint32_t>(), 4u + 2 + 10 + 12 + 8);
    EXPECT_EQ(in.take<char>(), 4);  // CreateImage
    EXPECT_EQ(in.take<char>(), 1);
    EXPECT_EQ(in.text(), "a picture");
    for (const int value : {width, height, 4}) EXPECT_EQ(in.take<std::int32_t>(), value);
    for (const char* channel : {"R", "G", "B", "A"}) EXPECT_EQ(in.text(), channel);

    std::vector<float> received(rgba.size());
    while (!in.is_at_end() && !HasFailure()) {
        const size_t start = in.at();
        const auto length = in.take<std::uint32_t>();
        EXPECT_EQ(in.take<char>(), 6);  // UpdateImage, version 3
        EXPECT_EQ(in.take<char>(), 0);
        EXPECT_EQ(in.text(), "a picture");
        EXPECT_EQ(in.take<std::int32_t>(), 4);
        for (const char* channel : {"R", "G", "B", "A"}) EXPECT_EQ(in.text(), channel);
        const auto x = in.take<std::int32_t>(), y = in.take<std::int32_t>();
        const auto w = in.take<std::int32_t>(), h = in.take<std::int32_t>();
        EXPECT_EQ(x, 0);
        EXPECT_EQ(w, width);
        ASSERT_LE(y + h, height);
        for (std::int64_t c = 0; c < 4; ++c) EXPECT_EQ(in.take<std::int64_t>(), c);
        for (std::int64_t c = 0; c < 4; ++c) EXPECT_EQ(in.take<std::int64_t>(), 4);
        for (int k = 0; k < 4 * w * h; ++k) received[size_t(4 * y * w + k)] = in.take<float>();
        EXPECT_EQ(in.at() - start, length);
    }
    EXPECT_EQ(received, rgba);
}

TEST(TevClient, SaysWhenNoOneAnswers)
{
    std::string address;
    {
        const Server gone;
        address = gone.address();
    }
    EXPECT_THROW(TevClient(address, "x", 1, 1), std::runtime_error);
    EXPECT_THROW(TevClient("no such host.invalid:1", "x", 1, 1), std::runtime_error);
}

TEST(TevClient, GoesOnWithoutAViewerThatLeft)
{
    Server server;
    std::thread receiving([&] { server.receive(1); });
    TevClient client(server.address(), "x", 64, 64);
    receiving.join();
    const std::vector<float> rgba(64 * 64 * 4);
    bool is_there = true;
    for (int k = 0; is_there && k < 1000; ++k) is_there = client.update(rgba);
    EXPECT_FALSE(is_there);
    EXPECT_FALSE(client.update(rgba));
}

}  // namespace
