// A viewer that knows tev's protocol, as far as Diptych speaks it.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <netinet/in.h>
#include <string>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>
#include <vector>

// Listens at a free port, and keeps what one client sends.
class TevServer {
public:
    TevServer() : listening_(socket(AF_INET, SOCK_STREAM, 0))
    {
        const timeval patience = {60, 0};  // with a client that never comes
        setsockopt(listening_, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
        sockaddr_in address = {};
        address.sin_family = AF_INET;
        address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        socklen_t length = sizeof address;
        EXPECT_EQ(bind(listening_, reinterpret_cast<sockaddr*>(&address), length), 0);
        EXPECT_EQ(listen(listening_, 1), 0);
        getsockname(listening_, reinterpret_cast<sockaddr*>(&address), &length);
        port_ = ntohs(address.sin_port);
    }
    ~TevServer() { close(listening_); }

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

class PacketReader {
public:
    explicit PacketReader(const std::string& bytes) : bytes_(bytes) {}

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

// What a viewer would show.
struct TevPicture {
    std::string name;
    int width = 0, height = 0;
    int updates = 0;  // packets of rows
    std::vector<float> rgba;
};

inline TevPicture parse_tev(const std::string& bytes)
{
    PacketReader in(bytes);
    TevPicture picture;
    const auto expect_head = [&](char kind, char focus) {
        EXPECT_EQ(in.take<char>(), kind);
        EXPECT_EQ(in.take<char>(), focus);
    };
    const auto expect_channels = [&] {
        for (const char* channel : {"R", "G", "B", "A"}) EXPECT_EQ(in.text(), channel);
    };
    const auto length = in.take<std::uint32_t>();
    expect_head(4, 1);  // CreateImage
    picture.name = in.text();
    picture.width = in.take<std::int32_t>();
    picture.height = in.take<std::int32_t>();
    EXPECT_EQ(in.take<std::int32_t>(), 4);
    expect_channels();
    EXPECT_EQ(in.at(), length);

    picture.rgba.resize(size_t(picture.width) * size_t(picture.height) * 4);
    for (; !in.is_at_end() && !testing::Test::HasFailure(); ++picture.updates) {
        const size_t start = in.at();
        const auto size = in.take<std::uint32_t>();
        expect_head(6, 0);  // UpdateImage, version 3
        EXPECT_EQ(in.text(), picture.name);
        EXPECT_EQ(in.take<std::int32_t>(), 4);
        expect_channels();
        const auto x = in.take<std::int32_t>(), y = in.take<std::int32_t>();
        const auto w = in.take<std::int32_t>(), h = in.take<std::int32_t>();
        EXPECT_EQ(x, 0);
        EXPECT_EQ(w, picture.width);
        EXPECT_LE(y + h, picture.height);
        for (std::int64_t c = 0; c < 4; ++c) EXPECT_EQ(in.take<std::int64_t>(), c);
        for (std::int64_t c = 0; c < 4; ++c) EXPECT_EQ(in.take<std::int64_t>(), 4);
        for (int k = 0; k < 4 * w * h && !testing::Test::HasFailure(); ++k)
            picture.rgba.at(size_t(4 * y * w + k)) = in.take<float>();
        EXPECT_EQ(in.at() - start, size);
    }
    return picture;
}
