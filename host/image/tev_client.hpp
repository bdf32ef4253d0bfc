// Shows pictures in a running tev viewer, by the protocol over TCP that tev documents: packets of a
// length, a kind and values, little-endian (https://github.com/Tom94/tev).
#pragma once

#include <span>
#include <string>

namespace diptych::image {

class TevClient {
public:
    // address: HOST:PORT, HOST or nothing, for localhost:14158 where tev listens. Opens a picture
    // of that name and size, channels R, G, B, A. Throws std::runtime_error when no one answers.
    TevClient(const std::string& address, const std::string& name, int width, int height);
    ~TevClient();
    TevClient(const TevClient&) = delete;
    TevClient& operator=(const TevClient&) = delete;

    // Four linear values a pixel, all rows from the top. False, from then on, when the viewer has
    // gone away.
    bool update(std::span<const float> rgba);

private:
    bool send_packet(std::string body);

    int socket_ = -1;
    std::string name_;
    int width_;
    int height_;
};

}  // namespace diptych::image
