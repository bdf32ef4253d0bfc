#include "texture_tool/find.hpp"

#include <algorithm>
#include <map>
#include <set>

#include <clang/AST/ASTConsumer.h>
#include <clang/AST/ASTContext.h>
#include <clang/Basic/Diagnostic.h>
#include <clang/Basic/FileManager.h>
#include <clang/Frontend/CompilerInstance.h>
#include <clang/Frontend/FrontendAction.h>
#include <clang/Lex/Lexer.h>
#include <clang/Lex/Preprocessor.h>
#include <clang/Tooling/Tooling.h>
#include <llvm/Config/llvm-config.h>
#include <llvm/Support/MemoryBuffer.h>
#include <llvm/Support/VirtualFileSystem.h>

#include "texture_tool/language.hpp"
#include "texture_tool/library.hpp"
#include "texture_tool/limits.hpp"
#include "texture_tool/messages.hpp"
#include "texture_tool/scan.hpp"
#include "texture_tool/walk.hpp"

namespace texture_tool {

namespace {

constexpr size_t most_tokens = 1000000;
const char* const parsed_name = "/texture.c";

// What Clang says, in the tool's words where it has better ones.
class Diagnostics : public clang::DiagnosticConsumer {
public:
    Diagnostics(const std::map<std::string, std::string>& own_names, Description& description)
        : own_names_(own_names), description_(description)
    {
    }

    void HandleDiagnostic(clang::DiagnosticsEngine::Level level,
                          const clang::Diagnostic& info) override
    {
        DiagnosticConsumer::HandleDiagnostic(level, info);
        llvm::SmallString<256> formatted;
        info.FormatDiagnostic(formatted);
        std::string text = formatted.str().str();
        Problem problem{description_.users_line, 1, true, ""};
        if (info.hasSourceManager() && info.getLocation().isValid()) {
            const clang::SourceManager& sources = info.getSourceManager();
            const clang::SourceLocation at = sources.getExpansionLoc(info.getLocation());
            if (sources.isInMainFile(at)) {
                problem.line = static_cast<int>(sources.getSpellingLineNumber(at));
                problem.column = static_cast<int>(sources.getSpellingColumnNumber(at));
            }
            if (text.find("does not return a value") != std::string::npos) {
                falls_off.insert({problem.line, problem.column});
                return;
            }
        }
        if (level < clang::DiagnosticsEngine::Error) return;
        for (const auto& [name, other] : own_names_)
            for (size_t at = 0; (at = text.find("'" + other + "'", at)) != std::string::npos; ++at)
                text.replace(at + 1, other.size(), name);
        has_errors = true;
        problem.text = with_remedy(
            is_call(info) ? "call to undeclared function" + text.substr(text.find(" '")) : text);
        const auto same = [&](const Problem& p) { return p.is_error && p.line == problem.line; };
        if (std::none_of(description_.problems.begin(), description_.problems.end(), same))
            description_.problems.push_back(problem);
    }

    // LLVM 19 calls unknown functions undeclared identifiers.
    static bool is_call(const clang::Diagnostic& info)
    {
        llvm::SmallString<64> text;
        info.FormatDiagnostic(text);
        if (text.str().find("use of undeclared identifier") != 0 || !info.hasSourceManager())
            return false;
        const char* at = info.getSourceManager().getCharacterData(
            info.getSourceManager().getExpansionLoc(info.getLocation()));
        while (isalnum(static_cast<unsigned char>(*at)) || *at == '_') ++at;
        while (*at == ' ') ++at;
        return *at == '(';
    }

    std::set<std::pair<int, int>> falls_off;  // closing braces of functions that may return nothing
    bool has_errors = false;

private:
    const std::map<std::string, std::string>& own_names_;
    Description& description_;
};

// The tokens that are left when the preprocessor is done.
class TokenList {
public:
    TokenList(const std::map<std::string, std::string>& own_names, Description& description)
        : description_(description)
    {
        for (const auto& [name, other] : own_names) real_names_[other] = name;
    }

    void collect(const clang::Preprocessor& preprocessor, const clang::Token& token)
    {
        const clang::SourceManager& sources = preprocessor.getSourceManager();
        const clang::SourceLocation at = token.getLocation();
        if (token.isAnnotation() || token.is(clang::tok::eof) || at.isInvalid()) return;
        const clang::SourceLocation start = sources.getExpansionLoc(at);
        if (!sources.isInMainFile(start)) return;
        if (description_.tokens.size() >= most_tokens)
            give_up("macros expand to more than a million tokens; use functions and loops");
        Token plain;
        plain.offset = static_cast<int>(sources.getFileOffset(start));
        plain.line = static_cast<int>(sources.getSpellingLineNumber(start));
        plain.column = static_cast<int>(sources.getSpellingColumnNumber(start));
        plain.is_from_macro = at.isMacroID();
        plain.text = preprocessor.getSpelling(token);
        if (const auto real = real_names_.find(plain.text); real != real_names_.end())
            plain.text = real->second;
        if (plain.is_from_macro) {
            const clang::SourceLocation last = sources.getExpansionRange(at).getEnd();
            plain.end = static_cast<int>(
                sources.getFileOffset(last) +
                clang::Lexer::MeasureTokenLength(last, sources, preprocessor.getLangOpts()));
        } else {
            plain.end = plain.offset + static_cast<int>(token.getLength());
        }
        numbers[at.getRawEncoding()] = static_cast<int>(description_.tokens.size());
        description_.tokens.push_back(plain);
    }

    std::map<unsigned, int> numbers;

private:
    Description& description_;
    std::map<std::string, std::string> real_names_;
};

class Consumer : public clang::ASTConsumer {
public:
    Consumer(TokenList& tokens, const std::map<std::string, std::string>& own_names,
             Diagnostics& diagnostics, Description& description)
        : tokens_(tokens), own_names_(own_names), diagnostics_(diagnostics),
          description_(description)
    {
    }

    void HandleTranslationUnit(clang::ASTContext& context) override
    {
        if (diagnostics_.has_errors) return;
        Walk(context, tokens_.numbers, own_names_, description_).run();
    }

private:
    TokenList& tokens_;
    const std::map<std::string, std::string>& own_names_;
    Diagnostics& diagnostics_;
    Description& description_;
};

class Action : public clang::ASTFrontendAction {
public:
    Action(TokenList& tokens, const std::map<std::string, std::string>& own_names,
           Diagnostics& diagnostics, Description& description)
        : tokens_(tokens), own_names_(own_names), diagnostics_(diagnostics),
          description_(description)
    {
    }

    std::unique_ptr<clang::ASTConsumer> CreateASTConsumer(clang::CompilerInstance& compiler,
                                                          llvm::StringRef) override
    {
        clang::Preprocessor& preprocessor = compiler.getPreprocessor();
        preprocessor.setTokenWatcher(
            [&](const clang::Token& token) { tokens_.collect(preprocessor, token); });
        return std::make_unique<Consumer>(tokens_, own_names_, diagnostics_, description_);
    }

private:
    TokenList& tokens_;
    const std::map<std::string, std::string>& own_names_;
    Diagnostics& diagnostics_;
    Description& description_;
};

void note_missing_returns(const Diagnostics& diagnostics, Description& description)
{
    for (Function& function : description.functions) {
        if (function.body_end < 0) continue;
        const Token& brace = description.tokens[function.body_end];
        if (!diagnostics.falls_off.count({brace.line, brace.column})) continue;
        function.returns_always = false;
        if (description.is_library(brace.line)) continue;
        description.problems.push_back({brace.line, brace.column, false,
                                        "'" + function.name +
                                            "' may end without a return and then "
                                            "gives 0; add a return at its end"});
    }
}

// Names that nothing is known by. The parser would complain of what is done with their values.
void check_names(const std::vector<Word>& words, const std::string& source,
                 std::vector<Problem>& problems)
{
    for (size_t k = 0; k + 2 < words.size(); ++k) {
        const bool is_attribute = words[k].text == "readAttr";
        if ((!is_attribute && words[k].text != "readSetting") || words[k + 1].text != "(") continue;
        const bool has_hit = k + 4 < words.size() && words[k + 3].text == ",";
        const Word& text = words[k + (has_hit ? 4 : 2)];
        if (text.text != "\"") continue;
        const size_t first = size_t(text.offset) + 1;
        const size_t end = source.find_first_of("\"\\\n", first);
        if (end == std::string::npos || source[end] != '"') continue;
        const std::string name = source.substr(first, end - first);
        const std::string problem = is_attribute ? attribute_problem(name) : setting_problem(name);
        if (!problem.empty()) problems.push_back({text.line, text.column, true, problem});
    }
}

// Macros can put together what the file's own words do not show.
void check_expansions(Description& description)
{
    std::vector<Word> words;
    for (const Token& token : description.tokens)
        if (!description.is_library(token.line))
            words.push_back({token.offset, token.line, token.column, false, false, token.text});
    std::vector<Problem> found;
    check_words(words, found);
    for (const Problem& problem : found) {
        const auto same = [&](const Problem& p) { return p.line == problem.line && p.is_error; };
        if (std::none_of(description.problems.begin(), description.problems.end(), same))
            description.problems.push_back(problem);
    }
}

}  // namespace

std::string parser_version() { return LLVM_VERSION_STRING; }

Description find(const std::string& name, const std::string& text)
{
    constexpr std::string_view mark = "\xef\xbb\xbf";  // that some editors put before UTF-8
    const std::string source = text.substr(text.compare(0, 3, mark) == 0 ? mark.size() : 0);
    Description description;
    description.file = name;
    description.source = source;
    if (source.size() > (1u << 20)) {
        description.problems.push_back({1, 1, true,
                                        "the file is larger than 1 MiB; give large tables as "
                                        "array arguments"});
        return description;
    }
    if (const size_t zero = source.find('\0'); zero != std::string::npos) {
        const int line = 1 + static_cast<int>(std::count(
                                 source.begin(), source.begin() + static_cast<long>(zero), '\n'));
        description.problems.push_back(
            {line, 1, true, "the file holds a zero byte; it is no text"});
        return description;
    }
    std::string parsed = source;
    const std::vector<Word> words = scan_words(source);
    check_words(words, description.problems);
    for (const Problem& problem : description.problems)
        if (problem.text.find("reads another file") != std::string::npos) return description;
    check_names(words, source, description.problems);
    blank_pragmas(words, parsed);
    const std::map<std::string, std::string> own_names = rename_own(words, parsed);
    const LibraryText library = library_for(words);
    parsed = library.text + parsed;
    description.source = library.text + source;
    description.sections = library.sections;
    description.users_line =
        1 + static_cast<int>(std::count(library.text.begin(), library.text.end(), '\n'));
    description.sections.push_back({name, description.users_line});
    for (Problem& problem : description.problems) problem.line += description.users_line - 1;

    llvm::IntrusiveRefCntPtr<llvm::vfs::InMemoryFileSystem> files(
        new llvm::vfs::InMemoryFileSystem);
    files->addFile(parsed_name, 0, llvm::MemoryBuffer::getMemBufferCopy(parsed));
    files->addFile("/prelude.h", 0, llvm::MemoryBuffer::getMemBufferCopy(prelude()));
    const llvm::IntrusiveRefCntPtr<clang::FileManager> manager(
        new clang::FileManager(clang::FileSystemOptions(), files));
    const std::vector<std::string> command = {"clang",
                                              "-x",
                                              "cl",
                                              "-cl-std=CL2.0",
                                              "-target",
                                              "spir64",
                                              "-cl-single-precision-constant",
                                              "-cl-no-stdinc",
                                              "-nostdinc",
                                              "-Xclang",
                                              "-fdeclare-opencl-builtins",
                                              "-fno-trigraphs",
                                              "-ffp-contract=off",
                                              "-fsyntax-only",
                                              "-fno-caret-diagnostics",
                                              "-Wno-everything",
                                              "-Wreturn-type",
                                              "-Wno-error=return-type",
                                              "-Werror=implicit-int",
                                              "-Werror=excess-initializers",
                                              "-Werror=incompatible-pointer-types",
                                              "-Werror=unsequenced",
                                              "-ferror-limit=20",
                                              "-include",
                                              "/prelude.h",
                                              parsed_name};
    Diagnostics diagnostics(own_names, description);
    TokenList tokens(own_names, description);
    clang::tooling::ToolInvocation invocation(
        command, std::make_unique<Action>(tokens, own_names, diagnostics, description),
        manager.get());
    invocation.setDiagnosticConsumer(&diagnostics);
    invocation.run();
    note_missing_returns(diagnostics, description);
    check_expansions(description);
    return description;
}

}  // namespace texture_tool
