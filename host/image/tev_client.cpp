#include "host/image/tev_client.hpp"

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <memory>
#include <netdb.h>
#include <stdexcept>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

namespace diptych::image {
namespace {

static_assert(std::endian::native == std::endian::little, "values go out as they lie in memory");

// Kinds of packets, and the newest of their versions.
constexpr char create_image = 4;
constexpr char update_image = 6;
constexpr char channels[] = {'R', 'G', 'B', 'A'};
constexpr int most_rows = 64;           // a packet
constexpr int seconds_of_patience = 5;  // with a viewer that does not take what is sent

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
        const timeval patience = {seconds_of_patience, 0};
        setsockopt(socket, SOL_SOCKET, SO_SNDTIMEO, &patience, sizeof patience);
        if (connect(socket, at->ai_addr, at->ai_addrlen) == 0) return socket;
        close(socket);
    }
    throw std::runtime_error("tev: no viewer answers at " + host + ":" + port +
                             "; start tev, or name its HOST:PORT");
}

}  // namespace

TevClient::TevClient(const std::string& address, const std::string& name, int width, int height)
    : socket_(connect_to(address)), name_(name), width_(width), height_(height)
{
    std::string body = head_of(create_image, true, name);
    append(body, std::int32_t(width));
    append(body, std::int32_t(height));
    append(body, std::int32_t(std::size(channels)));
    append_channels(body);
    send_packet(std::move(body));
}

TevClient::~TevClient()
{
    if (socket_ >= 0) close(socket_);
}

bool TevClient::update(std::span<const float> rgba)
{
    const auto count = std::int64_t(std::size(channels));
    bool is_sent = socket_ >= 0;
    for (int y = 0; is_sent && y < height_; y += most_rows) {
        const int rows = std::min(most_rows, height_ - y);
        std::string body = head_of(update_image, false, name_);
        append(body, std::int32_t(count));
        append_channels(body);
        for (const int value : {0, y, width_, rows}) append(body, std::int32_t(value));
        for (std::int64_t c = 0; c < count; ++c) append(body, c);      // where its values begin
        for (std::int64_t c = 0; c < count; ++c) append(body, count);  // from pixel to pixel
        const size_t row = size_t(width_) * size_t(count);
        body.append(reinterpret_cast<const char*>(&rgba[size_t(y) * row]),
                    size_t(rows) * row * sizeof(float));
        is_sent = send_packet(std::move(body));
    }
    return is_sent;
}

bool TevClient::send_packet(std::string body)
{
    std::string packet;
    append(packet, std::uint32_t(body.size() + sizeof(std::uint32_t)));  // counts itself
    packet += body;
    for (size_t sent = 0; socket_ >= 0 && sent < packet.size();) {
        const ssize_t now = send(socket_, packet.data() + sent, packet.size() - sent, MSG_NOSIGNAL);
        if (now > 0) {
            sent += size_t(now);
        } else if (errno != EINTR) {
            close(socket_);
            socket_ = -1;
        }
    }
    return socket_ >= 0;
}

}  // namespace diptych::image
