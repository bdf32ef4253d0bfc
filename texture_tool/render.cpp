#include "texture_tool/render.hpp"

#include <algorithm>
#include <cctype>
#include <set>

namespace texture_tool {

namespace {

// Where comments lie that may be copied: neither in a directive nor with anything in them that some
// compiler reads as the end of the line or of the comment.
std::vector<std::pair<int, int>> find_comments(const std::string& source)
{
    std::vector<std::pair<int, int>> comments;
    const int size = static_cast<int>(source.size());
    bool starts_line = true;
    bool is_in_directive = false;
    for (int i = 0; i < size;) {
        const char c = source[i];
        const char next = i + 1 < size ? source[i + 1] : '\0';
        if (c == '\\' && (next == '\n' || next == '\r')) {
            i += 2;
        } else if (c == '\n') {
            starts_line = true;
            is_in_directive = false;
            ++i;
        } else if (c == '"' || c == '\'') {
            for (++i; i < size && source[i] != c && source[i] != '\n'; ++i)
                if (source[i] == '\\') ++i;
            i = std::min(i + 1, size);
        } else if (c == '/' && (next == '/' || next == '*')) {
            const int start = i;
            if (next == '/') {
                while (i < size && source[i] != '\n') i += source[i] == '\\' ? 2 : 1;
                i = std::min(i, size);
            } else {
                const size_t end = source.find("*/", i + 2);
                i = end == std::string::npos ? size : static_cast<int>(end) + 2;
            }
            const std::string text = source.substr(start, i - start);
            if (!is_in_directive && text.find('\\') == std::string::npos &&
                text.find("??") == std::string::npos)
                comments.push_back({start, i});
        } else {
            if (starts_line && c == '#') is_in_directive = true;
            if (!isspace(static_cast<unsigned char>(c))) starts_line = false;
            ++i;
        }
    }
    return comments;
}

std::string without_trailing_space(const std::string& text)
{
    std::string trimmed;
    for (const char c : text) {
        if (c == '\n') trimmed.erase(trimmed.find_last_not_of(" \t") + 1);
        trimmed += c;
    }
    return trimmed;
}

}  // namespace

TokenText::TokenText(const Description& description)
    : description_(description), comments_(find_comments(description.source))
{
}

void TokenText::before(int token, const std::string& text)
{
    edits_[token].before = text + edits_[token].before;
}

void TokenText::after(int token, const std::string& text) { edits_[token].after += text; }

void TokenText::replace(int token, const std::string& text)
{
    edits_[token].is_replaced = true;
    edits_[token].text = text;
}

void TokenText::remove(Range range)
{
    for (int i = range.first; i <= range.last; ++i) {
        edits_.erase(i);
        replace(i, "");
    }
}

const TokenText::Edit* TokenText::edit(int token) const
{
    const auto found = edits_.find(token);
    return found == edits_.end() ? nullptr : &found->second;
}

std::string TokenText::token(int token) const
{
    const Edit* found = edit(token);
    if (!found) return description_.tokens[token].text;
    return found->before + (found->is_replaced ? found->text : description_.tokens[token].text) +
           found->after;
}

std::string TokenText::range(Range range) const
{
    std::string text;
    for (int i = range.first; i <= range.last; ++i) {
        const std::string one = token(i);
        if (!text.empty() && !one.empty()) text += " ";
        text += one;
    }
    return text;
}

// White space and comments; directives and what they leave out vanish, their lines stay.
std::string TokenText::gap(int from, int to) const
{
    std::string text;
    const std::string& source = description_.source;
    auto comment = std::lower_bound(comments_.begin(), comments_.end(), std::make_pair(from, 0));
    for (int i = from; i < to;) {
        while (comment != comments_.end() && comment->first < i) ++comment;
        if (comment != comments_.end() && comment->first == i && comment->second <= to) {
            text += source.substr(i, comment->second - i);
            i = comment->second;
            continue;
        }
        if (source[i] == '\n' || source[i] == ' ' || source[i] == '\t') text += source[i];
        ++i;
    }
    return text.empty() && to > from ? " " : text;
}

std::string TokenText::file() const
{
    const std::vector<Token>& tokens = description_.tokens;
    const int count = static_cast<int>(tokens.size());
    std::string text;
    int at = 0;
    for (int i = 0; i < count;) {
        std::string between = gap(at, tokens[i].offset);
        const Edit* last_edit = i > 0 ? edit(i - 1) : nullptr;
        if (last_edit && last_edit->is_replaced && last_edit->text.empty())
            between.erase(0, between.find_first_not_of(' ') == std::string::npos
                                 ? between.size()
                                 : between.find_first_not_of(' '));
        text += between;
        if (!tokens[i].is_from_macro) {
            text += token(i);
            at = tokens[i].end;
            ++i;
            continue;
        }
        int last = i;
        while (last + 1 < count && tokens[last + 1].is_from_macro &&
               tokens[last + 1].offset == tokens[i].offset)
            ++last;
        text += " " + range({i, last}) + " ";
        const auto start = description_.source.begin() + tokens[i].offset;
        text.append(std::count(start, description_.source.begin() + tokens[last].end, '\n'), '\n');
        at = tokens[last].end;
        i = last + 1;
    }
    text += gap(at, static_cast<int>(description_.source.size()));
    return without_trailing_space(text);
}

int TokenText::count_changed_lines() const
{
    std::set<int> lines;
    for (const auto& [number, change] : edits_)
        if (!change.before.empty() || !change.after.empty() ||
            (change.is_replaced && change.text != description_.tokens[number].text))
            lines.insert(description_.tokens[number].line);
    for (const Token& token : description_.tokens)
        if (token.is_from_macro) lines.insert(token.line);
    lines.erase(lines.begin(), lines.lower_bound(description_.users_line));
    return static_cast<int>(lines.size());
}

}  // namespace texture_tool
