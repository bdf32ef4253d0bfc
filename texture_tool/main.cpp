// diptych-texture: reads a user's texture and writes it in the two dialects that Diptych compiles.
#include <algorithm>
#include <fstream>
#include <iostream>
#include <iterator>
#include <optional>
#include <stdexcept>
#include <string>
#include <sys/stat.h>

#include "texture_tool/check.hpp"
#include "texture_tool/describe.hpp"
#include "texture_tool/find.hpp"
#include "texture_tool/limits.hpp"
#include "texture_tool/rewrite.hpp"

namespace {

using namespace texture_tool;

const char* const usage =
    "usage: diptych-texture FILE.c [--entry NAME] [--id ID] [--name PRINTED_NAME]\n"
    "                       [--opencl OUT.cl] [--cpp OUT.hpp] [--json OUT.json] [--check-only] "
    "[--watch values|indexes]\n"
    "Checks a texture and writes it as OpenCL C, as C++ and described in JSON.\n"
    "  --entry   the function that is the texture; else the only one that no other calls\n"
    "  --id      prefix and namespace of its names, a C identifier (texture)\n"
    "  --name    the file's name in messages and for debuggers (FILE.c)\n"
    "  --watch   the C++ notes in fault_line where a value first is not finite, or an index out of "
    "range\n"
    "OUT may be - for standard output. Exit code 0: good; 2: refused, with lines\n"
    "file:line:column: error: reason; remedy on standard error.\n";

struct Options {
    std::string file, entry, id = "texture", name, opencl, cpp, json;
    Variant cpp_variant = Variant::Cpp;
    bool wants_help = false;
    bool wants_version = false;
};

bool is_identifier(const std::string& text)
{
    const auto is_letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
    return !text.empty() && text.size() <= 64 && is_letter(text[0]) &&
           std::all_of(text.begin(), text.end(),
                       [&](char c) { return is_letter(c) || (c >= '0' && c <= '9') || c == '_'; });
}

Variant watched_variant(const std::string& what)
{
    if (what == "values") return Variant::WatchedValues;
    if (what == "indexes") return Variant::WatchedIndexes;
    throw std::runtime_error("--watch " + what + ": is neither values nor indexes");
}

Options parse(int count, char** values)
{
    Options options;
    for (int i = 1; i < count; ++i) {
        const std::string word = values[i];
        const auto value = [&] {
            if (i + 1 >= count) throw std::runtime_error(word + " needs a value; see --help");
            return std::string(values[++i]);
        };
        if (word == "--entry")
            options.entry = value();
        else if (word == "--id")
            options.id = value();
        else if (word == "--name")
            options.name = value();
        else if (word == "--opencl")
            options.opencl = value();
        else if (word == "--cpp")
            options.cpp = value();
        else if (word == "--json")
            options.json = value();
        else if (word == "--watch")
            options.cpp_variant = watched_variant(value());
        else if (word == "--check-only")
            continue;
        else if (word == "--version")
            options.wants_version = true;
        else if (word == "--help" || word == "-h")
            options.wants_help = true;
        else if (word.rfind("--", 0) == 0)
            throw std::runtime_error(word + ": unknown option; see --help");
        else if (options.file.empty())
            options.file = word;
        else
            throw std::runtime_error(word + ": one file at a time; see --help");
    }
    if (options.wants_help || options.wants_version) return options;
    if (options.file.empty()) throw std::runtime_error(std::string("no file given\n") + usage);
    if (!is_identifier(options.id))
        throw std::runtime_error("--id " + options.id +
                                 ": not an identifier; use letters, digits and _");
    if (options.name.empty()) options.name = options.file;
    return options;
}

std::string read(const std::string& path)
{
    struct stat status = {};
    if (stat(path.c_str(), &status) != 0)
        throw std::runtime_error(path + ": no such file; check the path");
    if (!S_ISREG(status.st_mode))
        throw std::runtime_error(path + ": not a file; give a texture's source");
    std::ifstream stream(path, std::ios::binary);
    if (!stream) throw std::runtime_error(path + ": cannot be read; check its permissions");
    if (status.st_size > (1 << 21)) return std::string((1 << 20) + 1, ' ');
    return {std::istreambuf_iterator<char>(stream), {}};
}

void write(const std::string& path, const std::string& text)
{
    if (path.empty()) return;
    if (path == "-") {
        std::cout << text;
        return;
    }
    std::ofstream stream(path, std::ios::binary);
    stream << text;
    if (!stream.flush()) throw std::runtime_error(path + ": cannot be written; check the folder");
}

int run(const Options& options)
{
    set_limits(options.name);
    Description description = find(options.name, read(options.file));
    check(description, options.entry);
    std::stable_sort(description.problems.begin(), description.problems.end(),
                     [](const Problem& a, const Problem& b) { return a.line < b.line; });
    for (const Problem& problem : description.problems)
        std::cerr << message(description, problem) << "\n";
    if (has_errors(description)) return 2;
    const Rewritten opencl = rewrite(description, Variant::OpenCl, options.id);
    const Rewritten cpp = rewrite(description, options.cpp_variant, options.id);
    write(options.opencl, opencl.text);
    write(options.cpp, cpp.text);
    write(options.json,
          describe(description, options.id, opencl.changed_lines, opencl.total_lines));
    return 0;
}

}  // namespace

int main(int count, char** values)
{
    try {
        const Options options = parse(count, values);
        if (options.wants_help) {
            std::cout << usage;
            return 0;
        }
        if (options.wants_version) {
            std::cout << "diptych-texture, LLVM " << parser_version() << "\n";
            return 0;
        }
        return run(options);
    } catch (const std::exception& error) {
        std::cerr << "diptych-texture: " << error.what() << "\n";
        return 2;
    }
}
