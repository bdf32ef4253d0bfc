#include "texture_tool/scan.hpp"

#include <cctype>
#include <set>

#include "texture_tool/language.hpp"

namespace texture_tool {

namespace {

bool is_word_character(char c)
{
    return isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '$' ||
           static_cast<unsigned char>(c) >= 128;
}

// Walks over the characters, line by line of the file.
class Scanner {
public:
    explicit Scanner(const std::string& source) : source_(source) {}

    std::vector<Word> run()
    {
        while (at_ < size()) step();
        return words_;
    }

private:
    int size() const { return static_cast<int>(source_.size()); }
    char peek(int ahead) const { return at_ + ahead < size() ? source_[at_ + ahead] : '\0'; }

    void advance(int count)
    {
        for (int i = 0; i < count && at_ < size(); ++i, ++at_) {
            ++column_;
            if (source_[at_] == '\n') {
                ++line_;
                column_ = 1;
            }
        }
    }

    int splice() const
    {
        if (peek(0) != '\\') return 0;
        if (peek(1) == '\n') return 2;
        return peek(1) == '\r' && peek(2) == '\n' ? 3 : 0;
    }

    void step()
    {
        if (const int length = splice()) return advance(length);
        const char c = peek(0);
        if (c == '\n') {
            starts_line_ = true;
            is_in_directive_ = false;
            return advance(1);
        }
        if (isspace(static_cast<unsigned char>(c))) return advance(1);
        if (c == '/' && peek(1) == '/') return line_comment();
        if (c == '/' && peek(1) == '*') return block_comment();
        if (c == '"' || c == '\'') return quoted(c);
        Word word{at_, line_, column_, starts_line_, false, ""};
        if (starts_line_ && c == '#') is_in_directive_ = true;
        word.is_in_directive = is_in_directive_;
        starts_line_ = false;
        if (is_word_character(c)) {
            while (at_ < size() && (is_word_character(peek(0)) || splice())) {
                const int length = splice();
                if (!length) word.text += peek(0);
                advance(length ? length : 1);
            }
        } else {
            word.text = c;
            advance(1);
        }
        words_.push_back(word);
    }

    void line_comment()
    {
        while (at_ < size() && peek(0) != '\n') advance(splice() ? splice() : 1);
    }

    void block_comment()
    {
        advance(2);
        while (at_ < size() && !(peek(0) == '*' && peek(1) == '/')) advance(1);
        advance(2);
    }

    void quoted(char quote)
    {
        words_.push_back(
            {at_, line_, column_, starts_line_, is_in_directive_, std::string(1, quote)});
        starts_line_ = false;
        advance(1);
        while (at_ < size() && peek(0) != quote && peek(0) != '\n')
            advance(peek(0) == '\\' ? 2 : 1);
        if (peek(0) == quote) advance(1);
    }

    const std::string& source_;
    int at_ = 0;
    int line_ = 1;
    int column_ = 1;
    bool starts_line_ = true;
    bool is_in_directive_ = false;
    std::vector<Word> words_;
};

void complain(std::vector<Problem>& problems, const Word& at, const std::string& text,
              bool is_error = true)
{
    problems.push_back({at.line, at.column, is_error, text});
}

void check_directive(const Word& hash, const Word& name, std::vector<Problem>& problems)
{
    static const std::set<std::string> allowed = {"define", "undef",   "if",   "ifdef",
                                                  "ifndef", "elif",    "else", "endif",
                                                  "error",  "warning", "line"};
    if (name.text == "include" || name.text == "include_next" || name.text == "import" ||
        name.text == "embed")
        complain(problems, hash,
                 "#" + name.text +
                     " reads another file, which textures may not; paste what you "
                     "need of it, OpenCL's functions are there without it");
    else if (name.text == "pragma")
        complain(problems, hash, "this #pragma has no effect; remove it", false);
    else if (!allowed.count(name.text))
        complain(problems, hash, "#" + name.text + " is not part of the language; remove it");
}

void check_word(const Word& word, std::vector<Problem>& problems)
{
    static const std::set<std::string> known = {
        "__constant", "__global",   "__private", "__kernel",           "__local",
        "__inline",   "__restrict", "__LINE__",  "__OPENCL_VERSION__", "__OPENCL_C_VERSION__"};
    const std::string& text = word.text;
    if (text == "__attribute__" || text == "__attribute" || text == "__declspec")
        complain(problems, word,
                 "attributes are not part of the language: " + text +
                     " could change what the "
                     "compiler does; remove it");
    else if (text == "asm" || text == "__asm__" || text == "__asm")
        complain(problems, word, "assembly runs on one processor only; write it in C");
    else if (text == "_Alignas" || text == "_Noreturn")
        complain(problems, word, text + " is not C99, and C++ spells it otherwise; remove it");
    else if (text == "_Pragma" || text == "__pragma")
        complain(problems, word, text + " is not part of the language; remove it");
    else if (text.rfind("__has_", 0) == 0)
        complain(problems, word, text + " asks about one compiler; remove it");
    else if (text.rfind("__builtin", 0) == 0)
        complain(problems, word,
                 "unknown function '" + text + "': compilers' own functions differ; use OpenCL's");
    else if (text.rfind("__", 0) == 0 && !word.is_in_directive && !known.count(text))
        complain(problems, word, "'" + text + "' belongs to the compiler; write it in C99");
    else if (is_opencl_word(text))
        complain(problems, word, "'" + text + "' is reserved by OpenCL C; choose another name");
    else if (text == "double" || text == "half")
        complain(problems, word, "'" + text + "' is not available on every device; use float");
    else
        for (const char c : text)
            if (static_cast<unsigned char>(c) >= 128 || c == '$') {
                complain(problems, word,
                         "'" + text +
                             "' is not a name that every compiler takes; use the letters "
                             "a to z, digits and _");
                break;
            }
}

bool is_name(const std::string& text)
{
    return !text.empty() && (isalpha(static_cast<unsigned char>(text[0])) || text[0] == '_');
}

bool starts_directive(const std::vector<Word>& words, size_t i)
{
    return words[i].starts_line && words[i].text == "#" && i + 1 < words.size() &&
           words[i + 1].is_in_directive && is_name(words[i + 1].text);
}

}  // namespace

std::vector<Word> scan_words(const std::string& source) { return Scanner(source).run(); }

void check_words(const std::vector<Word>& words, std::vector<Problem>& problems)
{
    for (size_t i = 0; i < words.size(); ++i) {
        const Word& word = words[i];
        const std::string next = i + 1 < words.size() ? words[i + 1].text : "";
        if ((word.text == "[" && next == "[") || word.text == "<:" ||
            (word.text == "<" && next == ":"))
            complain(problems, word,
                     "attributes and digraphs are not part of the language: " + word.text + next +
                         " could change what the compiler does; remove it");
        if (starts_directive(words, i))
            check_directive(word, words[i + 1], problems);
        else
            check_word(word, problems);
    }
}

void blank_pragmas(const std::vector<Word>& words, std::string& source)
{
    for (size_t i = 0; i + 1 < words.size(); ++i) {
        if (!starts_directive(words, i) || words[i + 1].text != "pragma") continue;
        size_t next = i + 1;
        while (next < words.size() && words[next].is_in_directive && !words[next].starts_line)
            ++next;
        const size_t end =
            next < words.size() ? static_cast<size_t>(words[next].offset) : source.size();
        for (size_t at = static_cast<size_t>(words[i].offset); at < end; ++at)
            if (source[at] != '\n') source[at] = ' ';
    }
}

std::map<std::string, std::string> rename_own(const std::vector<Word>& words, std::string& source)
{
    std::set<std::string> all;
    std::set<std::string> own;
    int depth = 0;
    for (size_t i = 0; i < words.size(); ++i) {
        const Word& word = words[i];
        all.insert(word.text);
        if (word.is_in_directive) continue;
        const std::string next = i + 1 < words.size() ? words[i + 1].text : "";
        const std::string before = i > 0 && !words[i - 1].is_in_directive ? words[i - 1].text : "";
        if (word.text == "{") ++depth;
        if (word.text == "}") --depth;
        const bool declares = depth == 0 && next == "(" && (is_name(before) || before == "*");
        if (declares && (word.text == "main" || is_library_function(word.text) ||
                         is_engine_function(word.text)))
            own.insert(word.text);
        if (depth == 0 && before == "}" && is_engine_type(word.text)) own.insert(word.text);
    }
    std::map<std::string, std::string> names;
    for (const std::string& name : own) {
        std::string other = name;
        for (int n = 0; n < 1000 && (all.count(other) || names.count(other)); ++n) {
            const std::string digits = std::to_string(n);
            other = name.size() > digits.size()
                        ? name.substr(0, name.size() - digits.size()) + digits
                        : "q" + digits;
        }
        if (other.size() == name.size()) names[name] = other;
    }
    for (const Word& word : words) {
        const auto other = names.find(word.text);
        if (other != names.end() && source.compare(word.offset, word.text.size(), word.text) == 0)
            source.replace(word.offset, word.text.size(), other->second);
    }
    return names;
}

}  // namespace texture_tool
