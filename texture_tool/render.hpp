// Tokens back to text: edits hang on tokens, everything between them is the user's own.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "texture_tool/description.hpp"

namespace texture_tool {

class TokenText {
public:
    explicit TokenText(const Description& description);

    // Text before and after a token; what is added later lies outside of what was there.
    void before(int token, const std::string& text);
    void after(int token, const std::string& text);
    void replace(int token, const std::string& text);
    void remove(Range range);
    std::string token(int token) const;    // with its edits
    std::string range(Range range) const;  // in one line

    // Line for line as the user's file; a `#line` that numbers them is the caller's.
    std::string file() const;
    int count_changed_lines() const;

private:
    struct Edit {
        std::string before, after;
        bool is_replaced = false;
        std::string text;
    };
    std::string gap(int from, int to) const;
    const Edit* edit(int token) const;

    const Description& description_;
    std::map<int, Edit> edits_;
    std::vector<std::pair<int, int>> comments_;  // outside of directives
};

}  // namespace texture_tool
