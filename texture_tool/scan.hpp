// What the bare characters of a file tell before Clang reads it.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "texture_tool/description.hpp"

namespace texture_tool {

struct Word {
    int offset = 0;
    int line = 0;
    int column = 0;
    bool starts_line = false;
    bool is_in_directive = false;
    std::string text;
};

// Comments, literals and splices are passed over; every other word or sign is one entry.
std::vector<Word> scan_words(const std::string& source);

// Directives and words that no texture may hold.
void check_words(const std::vector<Word>& words, std::vector<Problem>& problems);

// Takes every #pragma out of `source`, whose lines and offsets stay.
void blank_pragmas(const std::vector<Word>& words, std::string& source);

// The user's own functions and types that share a name with the language's: each gets another name
// of the same length for the parser, so that the user's wins. Changes `source` in place.
std::map<std::string, std::string> rename_own(const std::vector<Word>& words, std::string& source);

}  // namespace texture_tool
