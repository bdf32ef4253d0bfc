#include "host/live/line_reader.hpp"

#include <cerrno>
#include <poll.h>
#include <unistd.h>

namespace diptych {
namespace {

// A line longer than this is nobody's typing.
constexpr size_t longest_line = size_t(1) << 20;

std::string trimmed(const std::string& text)
{
    const size_t first = text.find_first_not_of(" \t\r");
    return first == std::string::npos
               ? ""
               : text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

}  // namespace

// False: nothing more for now.
bool LineReader::read_more()
{
    pollfd ready{descriptor_, POLLIN, 0};
    if (descriptor_ < 0 || poll(&ready, 1, 0) <= 0) return false;
    char buffer[4096];
    const ssize_t got = read(descriptor_, buffer, sizeof buffer);
    if (got < 0 && (errno == EINTR || errno == EAGAIN)) return false;
    if (got <= 0) {
        descriptor_ = -1;
        if (!rest_.empty()) rest_ += '\n';
        return false;
    }
    rest_.append(buffer, size_t(got));
    return rest_.size() < longest_line;
}

std::vector<std::string> LineReader::lines()
{
    while (read_more()) {
    }
    std::vector<std::string> lines;
    size_t at = 0;
    for (size_t end; (end = rest_.find('\n', at)) != std::string::npos; at = end + 1)
        if (std::string line = trimmed(rest_.substr(at, end - at)); !line.empty())
            lines.push_back(std::move(line));
    rest_.erase(0, at);
    if (rest_.size() >= longest_line) rest_.clear();
    return lines;
}

}  // namespace diptych
