// Shows pictures in a running tev viewer, by the protocol over TCP that tev documents: packets of a
// length, a kind and values, little-endian (https://github.com/Tom94/tev).
#pragma once

#include <chrono>
#include <string>
#include <vector>

namespace diptych::image {

class TevClient {
public:
    // address: HOST:PORT, HOST or nothing, for localhost:14158 where tev listens. Opens a picture
    // of that name and size, channels R, G, B, A. Throws std::runtime_error when no one answers.
    TevClient(const std::string& address, const std::string& name, int width, int height);
    ~TevClient();
    TevClient(const TevClient&) = delete;
    TevClient& operator=(const TevClient&) = delete;

    // A picture to send: four linear values a pixel, all rows from the top. What has not been sent
    // of the one before is left out.
    void show(std::vector<float> rgba);
    bool is_idle() const;  // all of it has been sent

    // Sends what the viewer takes at once. False, from then on, when it has gone away, or has taken
    // nothing for seconds.
    bool go_on();
    // Waits until all has been sent, but not for a viewer that takes nothing. Returns as go_on().
    bool finish();

private:
    using Clock = std::chrono::steady_clock;

    void begin_packet(const std::string& body);
    void begin_rows();
    void leave();

    int socket_ = -1;
    std::string name_;
    int width_;
    int height_;
    std::vector<float> rgba_;
    int next_row_;                                 // of those that are not in a packet yet
    std::string packet_;                           // under way
    size_t sent_ = 0;                              // of its bytes
    Clock::time_point last_taken_ = Clock::now();  // or given, where all had been taken
};

}  // namespace diptych::image
