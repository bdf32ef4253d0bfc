// The functions that ship with the tool (library/functions/*.c), put before a user's text that
// calls them.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "texture_tool/description.hpp"
#include "texture_tool/scan.hpp"

namespace texture_tool {

// The families that the user's text needs, in an order in which every call sees its definition; a
// name that the user declares as well is the user's, the library's gets another.
struct LibraryText {
    std::string text;
    std::vector<Section> sections;
};

LibraryText library_for(const std::vector<Word>& users_words);

}  // namespace texture_tool
