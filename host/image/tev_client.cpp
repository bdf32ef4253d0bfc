#include "host/image/tev_client.hpp"

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <memory>
#include <netdb.h>
#include <poll.h>
#include <stdexcept>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>
#include <utility>

namespace diptych::image {
namespace {

static_assert(std::endian::native == std::endian::little, "values go out as they lie in memory");

// Kinds of packets, and the newest of their versions.
constexpr char create_image = 4;
constexpr char update_image = 6;
constexpr char channels[] = {'R', 'G', 'B', 'A'};
constexpr int most_rows = 64;  // a packet
// With one that does not answer; with one that takes nothing while the program does other things,
// or while it waits at the end; and with one that takes the last picture slowly.
constexpr std::chrono::seconds patience_at_first{5}, patience_meanwhile{5}, patience_in_all{5};
constexpr std::chrono::milliseconds patience_at_the_end{200};

template<class Value>
void append(std::string& body, Value value)
{
    body.append(reinterpret_cast<const char*>(&value), sizeof value);
}

// Kind, whether to bring the picture to the front, and its name.
std::string head_of(char kind, bool takes_focus, const std::string& name)
{
    std::string body;
    body += kind;
    body += char(takes_focus);
    body += name;
    body += '\0';
    return body;
}

void append_channels(std::string& body)
{
    for (const char channel : channels) {
        body += channel;
        body += '\0';
    }
}

int connect_to(const std::string& address)
{
    const size_t colon = address.rfind(':');
    std::string host = address.substr(0, colon), port = "14158";
    if (colon != std::string::npos) port = address.substr(colon + 1);
    if (host.empty()) host = "localhost";
    addrinfo hints = {}, *found = nullptr;
    hints.ai_socktype = SOCK_STREAM;
    const int error = getaddrinfo(host.c_str(), port.c_str(), &hints, &found);
    const std::unique_ptr<addrinfo, void (*)(addrinfo*)> freed(error ? nullptr : found,
                                                               [](addrinfo* list) {
                                                                   if (list) freeaddrinfo(list);
                                                               });
    for (const addrinfo* at = freed.get(); at; at = at->ai_next) {
        const int socket = ::socket(at->ai_family, at->ai_socktype, at->ai_protocol);
        if (socket < 0) continue;
        const timeval patience = {patience_at_first.count(), 0};
        setsockopt(socket, SOL_SOCKET, SO_SNDTIMEO, &patience, sizeof patience);
        if (connect(socket, at->ai_addr, at->ai_addrlen) == 0) return socket;
        close(socket);
    }
    throw std::runtime_error("tev: no viewer answers at " + host + ":" + port +
                             "; start tev, or name its HOST:PORT");
}

}  // namespace

TevClient::TevClient(const std::string& address, const std::string& name, int width, int height)
    : socket_(connect_to(address)), name_(name), width_(width), height_(height), next_row_(height)
{
    std::string body = head_of(create_image, true, name);
    append(body, std::int32_t(width));
    append(body, std::int32_t(height));
    append(body, std::int32_t(std::size(channels)));
    append_channels(body);
    begin_packet(body);
    go_on();
}

TevClient::~TevClient() { leave(); }

void TevClient::show(std::vector<float> rgba)
{
    if (is_idle()) last_taken_ = Clock::now();
    rgba_ = std::move(rgba);
    next_row_ = 0;
}

bool TevClient::is_idle() const { return sent_ == packet_.size() && next_row_ == height_; }

bool TevClient::go_on()
{
    while (socket_ >= 0 && !is_idle()) {
        if (sent_ == packet_.size()) begin_rows();
        const ssize_t now = send(socket_, packet_.data() + sent_, packet_.size() - sent_,
                                 MSG_NOSIGNAL | MSG_DONTWAIT);
        if (now > 0) {
            sent_ += size_t(now);
            last_taken_ = Clock::now();
        } else if (errno == EAGAIN) {
            if (Clock::now() - last_taken_ > patience_meanwhile) leave();
            break;
        } else if (errno != EINTR) {
            leave();
        }
    }
    return socket_ >= 0;
}

bool TevClient::finish()
{
    const Clock::time_point end = Clock::now() + patience_in_all;
    while (go_on() && !is_idle()) {
        pollfd viewer = {socket_, POLLOUT, 0};
        if (poll(&viewer, 1, int(patience_at_the_end.count())) == 0 || Clock::now() > end) leave();
    }
    return socket_ >= 0;
}

void TevClient::begin_packet(const std::string& body)
{
    packet_.clear();
    append(packet_, std::uint32_t(body.size() + sizeof(std::uint32_t)));  // counts itself
    packet_ += body;
    sent_ = 0;
}

void TevClient::begin_rows()
{
    const auto count = std::int64_t(std::size(channels));
    const int rows = std::min(most_rows, height_ - next_row_);
    std::string body = head_of(update_image, false, name_);
    append(body, std::int32_t(count));
    append_channels(body);
    for (const int value : {0, next_row_, width_, rows}) append(body, std::int32_t(value));
    for (std::int64_t c = 0; c < count; ++c) append(body, c);      // where its values begin
    for (std::int64_t c = 0; c < count; ++c) append(body, count);  // from pixel to pixel
    const size_t row = size_t(width_) * size_t(count);
    body.append(reinterpret_cast<const char*>(&rgba_[size_t(next_row_) * row]),
                size_t(rows) * row * sizeof(float));
    begin_packet(body);
    next_row_ += rows;
}

void TevClient::leave()
{
    if (socket_ >= 0) close(socket_);
    socket_ = -1;
}

}  // namespace diptych::image
