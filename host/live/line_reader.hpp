// Lines that somebody types, or a program writes, without waiting for them.
#pragma once

#include <string>
#include <vector>

namespace diptych {

class LineReader {
public:
    explicit LineReader(int descriptor) : descriptor_(descriptor) {}

    // What can be waited for; -1 once the input has ended.
    int descriptor() const { return descriptor_; }
    // The whole lines that have come since, blanks around them removed, empty ones left out; at the
    // end of the input what is left counts as a line.
    std::vector<std::string> lines();

private:
    bool read_more();

    int descriptor_;
    std::string rest_;
};

}  // namespace diptych
