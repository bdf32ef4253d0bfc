#include "texture_tool/library.hpp"

#include <algorithm>
#include <cctype>

#include "texture_tool/library_sources.hpp"

namespace texture_tool {

namespace {

struct Family {
    std::string name;
    std::string text;
    std::vector<Word> words;
    std::set<std::string> defined;
    bool is_needed = false;
};

bool is_name(const std::string& text)
{
    return isalpha(static_cast<unsigned char>(text[0])) || text[0] == '_';
}

// Names declared at file level.
std::set<std::string> declared(const std::vector<Word>& words)
{
    std::set<std::string> names;
    int depth = 0;
    for (size_t i = 1; i < words.size(); ++i) {
        const std::string& text = words[i].text;
        const std::string& before = words[i - 1].text;
        if (text == "{" || text == "(") ++depth;
        if (text == "}" || text == ")") --depth;
        if (words[i].is_in_directive) {
            if (before == "define") names.insert(text);
        } else if (depth == 0 && is_name(text) && i + 1 < words.size() &&
                   (is_name(before) || before == "*" || before == "}") &&
                   std::string("(=[;,").find(words[i + 1].text) != std::string::npos) {
            names.insert(text);
        }
    }
    return names;
}

std::vector<Family> families()
{
    std::vector<Family> list;
    for (const auto& [name, text] : library_sources) {
        Family family{name, text, scan_words(text), {}, false};
        family.defined = declared(family.words);
        list.push_back(std::move(family));
    }
    return list;
}

void need(std::vector<Family>& list, const std::vector<Word>& words,
          const std::set<std::string>& own)
{
    for (const Word& word : words) {
        if (own.count(word.text)) continue;
        for (Family& family : list) {
            if (family.is_needed || !family.defined.count(word.text)) continue;
            family.is_needed = true;
            need(list, family.words, {});
        }
    }
}

std::string renamed(const Family& family, const std::set<std::string>& own)
{
    std::string text = family.text;
    for (auto word = family.words.rbegin(); word != family.words.rend(); ++word)
        if (own.count(word->text))
            text.replace(word->offset, word->text.size(), "library_" + word->text);
    return text;
}

}  // namespace

LibraryText library_for(const std::vector<Word>& users_words)
{
    std::vector<Family> list = families();
    std::set<std::string> library_names;
    for (const Family& family : list)
        library_names.insert(family.defined.begin(), family.defined.end());
    std::set<std::string> own;
    for (const std::string& name : declared(users_words))
        if (library_names.count(name)) own.insert(name);
    need(list, users_words, own);
    LibraryText library;
    int line = 1;
    for (const Family& family : list) {
        if (!family.is_needed) continue;
        const std::string text = renamed(family, own);
        library.sections.push_back({"library/" + family.name, line});
        library.text += text;
        line += static_cast<int>(std::count(text.begin(), text.end(), '\n'));
    }
    return library;
}

}  // namespace texture_tool
