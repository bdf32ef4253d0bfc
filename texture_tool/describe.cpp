#include "texture_tool/describe.hpp"

#include <llvm/Support/JSON.h>
#include <llvm/Support/raw_ostream.h>

namespace texture_tool {

namespace {

std::string as_utf8(const std::string& text)
{
    return llvm::json::isUTF8(text) ? text : llvm::json::fixUTF8(text);
}

llvm::json::Array names(const std::vector<std::string>& list)
{
    llvm::json::Array array;
    for (const std::string& name : list) array.push_back(name);
    return array;
}

llvm::json::Array arguments(const Function& entry)
{
    llvm::json::Array array;
    for (const Parameter& parameter : entry.parameters) {
        if (parameter.passing == Passing::Engine) continue;
        const bool is_array = parameter.passing == Passing::View;
        array.push_back(llvm::json::Object{
            {"name", parameter.name},
            {"type", parameter.type},
            {"is_array", is_array},
            {"length",
             parameter.length ? llvm::json::Value(*parameter.length) : llvm::json::Value(nullptr)},
        });
    }
    return array;
}

llvm::json::Array occlusion(const Description& description)
{
    llvm::json::Array array;
    for (const OcclusionRequest& request : description.occlusion)
        array.push_back(llvm::json::Object{
            {"distance", request.distance ? llvm::json::Value(*request.distance)
                                          : llvm::json::Value(llvm::json::Object{
                                                {"argument", request.argument_number}})},
            {"hemisphere", request.hemisphere},
            {"same_object", request.same_object},
        });
    return array;
}

}  // namespace

std::string message(const Description& description, const Problem& problem)
{
    const Section at = description.place(problem.line);
    return at.file + ":" + std::to_string(at.line) + ":" + std::to_string(problem.column) +
           (problem.is_error ? ": error: " : ": warning: ") + problem.text;
}

std::string describe(const Description& description, const std::string& id, int changed_lines,
                     int total_lines)
{
    const Function& entry = description.functions[description.entry];
    llvm::json::Array warnings;
    for (const Problem& problem : description.problems)
        if (!problem.is_error) warnings.push_back(as_utf8(message(description, problem)));
    const llvm::json::Value value = llvm::json::Object{
        {"entry", entry.name},
        {"id", id},
        {"file", as_utf8(description.file)},
        {"line", description.place(entry.line).line},
        {"result", entry.result},
        {"arguments", arguments(entry)},
        {"attributes", names(description.attributes)},
        {"settings", names(description.settings)},
        {"occlusion", occlusion(description)},
        {"images", description.reads_images},
        {"changed_lines", changed_lines},
        {"total_lines", total_lines},
        {"warnings", std::move(warnings)},
    };
    std::string text;
    llvm::raw_string_ostream stream(text);
    stream << llvm::formatv("{0:2}", value) << "\n";
    stream.flush();
    return text;
}

}  // namespace texture_tool
