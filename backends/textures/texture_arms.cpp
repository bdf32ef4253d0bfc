#include "backends/textures/texture_arms.hpp"

#include "common/textures/procedural.h"

#include <algorithm>
#include <bit>
#include <cstdio>
#include <cstring>
#include <iterator>
#include <map>
#include <stdexcept>

namespace diptych {
namespace {

constexpr size_t most_pasted = 4096;  // nodes of a program, children as often as they are read

// `expression` with `value` wherever it reads argument `a`, which has that type.
std::string with_argument(std::string expression, const std::string& type, size_t a,
                          const std::string& value)
{
    const std::string rest = ", region, " + std::to_string(a) + ")";
    for (const std::string& call : {"tx_argument_" + type + "(", "tx_argument_view_" + type + "("})
        for (size_t at = 0; (at = expression.find(call, at)) != std::string::npos;) {
            const size_t comma = std::min(expression.find(',', at), expression.size());
            if (expression.compare(comma, rest.size(), rest) == 0) {
                expression.replace(at, comma + rest.size() - at, value);
                at += value.size();
            } else {
                at += call.size();
            }
        }
    return expression;
}

// The words behind the materials, as material_word() reads them.
class Words {
public:
    explicit Words(const SceneData& scene) : materials_(scene.materials) {}
    uint operator[](int word) const
    {
        uint value = 0;
        std::memcpy(&value,
                    reinterpret_cast<const char*>(materials_.data()) + size_t(word) * sizeof value,
                    sizeof value);
        return value;
    }
    int at(int word) const { return int((*this)[word]); }

private:
    const std::vector<Material>& materials_;
};

std::string number(uint word, char kind)
{
    if (kind == 'u') return std::to_string(word) + "u";
    if (kind == 'i') return std::string("(int)") + std::to_string(word) + "u";
    char text[64];
    std::snprintf(text, sizeof text, "%af", double(std::bit_cast<float>(word)));
    return text;
}

// One element of the type, whose words begin at `word`, as a constant expression.
std::string element(const Words& words, int word, const TextureArgument& argument)
{
    if (argument.type == "sam2D")  // its number counts from 1
        return std::string("{") + std::to_string(words.at(word) + 1) + "}";
    const char kind = argument.type[0];
    const int width = width_of(argument);
    std::string text;
    for (int k = 0; k < width; ++k) text += (k > 0 ? ", " : "") + number(words[word + k], kind);
    return width == 1 ? text : "TX_NEW(" + argument.type + ", " + text + ")";
}

// What another node gives, as an argument of the type takes it.
std::string of_node(const std::string& value, const TextureArgument& argument)
{
    const int width = width_of(argument);
    if (width == 1) return value + ".x";
    if (width == 4) return value;
    std::string text = "TX_NEW(" + argument.type;
    for (int k = 0; k < width; ++k) text += std::string(", ") + value + "." + "xyz"[k];
    return text + ")";
}

// What the entry of a function returns: the call of the user's own function with its arguments.
std::string returned_by_entry(const std::string& text, const std::string& id)
{
    const size_t entry = text.find(" " + id + "_entry(");
    const size_t start = entry == std::string::npos ? entry : text.find("return ", entry);
    const size_t end = start == std::string::npos ? start : text.find(";\n}", start);
    if (end == std::string::npos)
        throw std::runtime_error("texture " + id +
                                 ": its entry is not as the texture tool "
                                 "writes it; use the tool of this version");
    return text.substr(start + 7, end - start - 7);
}

// One material's program as functions without arguments, one for each of its results.
class Pasting {
public:
    explicit Pasting(const SceneData& scene) : scene_(scene), words_(scene) {}

    struct Result {
        TextureFunction function;
        int outputs;
    };

    std::vector<Result> program(int word, int number) const
    {
        std::map<int, Node> in_slot;  // what lies there
        std::vector<Result> results;
        std::string cpp, opencl;  // the steps' functions
        for (int k = 0; k < words_.at(word); ++k) {
            const int step = word + TEXTURE_PROGRAM_WORDS + k * TEXTURE_STEP_WORDS;
            std::string name = "step_";
            name += std::to_string(number) + "_" + std::to_string(k);
            const TextureFunction& function = function_of(step);
            cpp += "namespace " + function.id + " {\n" + step_function(step, name, function.cpp) +
                   "}\n";
            opencl += step_function(step, name, function.opencl);
            const Node node = paste(step, name, in_slot);
            in_slot[words_.at(step + 2)] = node;
            if (words_.at(step + 3) != 0)
                results.push_back({function_for(node, name, step), words_.at(step + 3)});
        }
        results.front().function.cpp = cpp + results.front().function.cpp;
        results.front().function.opencl = opencl + results.front().function.opencl;
        return results;
    }

private:
    // A node pasted: its value as an expression, in both dialects.
    struct Node {
        std::string cpp, opencl;
        size_t nodes = 1;
    };

    const TextureFunction& function_of(int step) const
    {
        return scene_.textures.functions.at(size_t(words_.at(step)));
    }

    int descriptor(int step, size_t argument) const
    {
        return words_.at(step + 1) + int(argument) * TEXTURE_DESCRIPTOR_WORDS;
    }

    TextureFunction function_for(const Node& node, const std::string& name, int step) const
    {
        TextureFunction function = function_of(step);
        function.id = name;
        function.arguments.clear();
        const auto entry = [&](const std::string& value) {
            return "SHARED float4 " + name + "_entry(TextureContext* tx, int region)\n{\n" +
                   "    (void)region;\n    return " + value + ";\n}\n";
        };
        function.cpp = "namespace " + name + " {\n" + entry(node.cpp) + "}\n";
        function.opencl = entry(node.opencl);
        return function;
    }

    Node paste(int step, const std::string& name, const std::map<int, Node>& in_slot) const
    {
        const TextureFunction& function = function_of(step);
        Node node{function.id + "::" + name + "(tx", name + "(tx"};
        for (size_t a = 0; a < function.arguments.size(); ++a) {
            const int source = words_.at(descriptor(step, a));
            if (source < 0) continue;
            const Node& child = in_slot.at(source);
            node.nodes += child.nodes;
            if (node.nodes > most_pasted)
                throw std::runtime_error("the study's pasted arm: a material's nodes, pasted where "
                                         "they are read, are more than " +
                                         std::to_string(most_pasted) + "; share fewer of them");
            node.cpp += ", " + child.cpp;
            node.opencl += ", " + child.opencl;
        }
        node.cpp += ")";
        node.opencl += ")";
        return node;
    }

    // The node as a function of the nodes that it reads; `text`: the function's own.
    std::string step_function(int step, const std::string& name, const std::string& text) const
    {
        const TextureFunction& function = function_of(step);
        std::string expression = returned_by_entry(text, function.id), parameters, tables;
        for (size_t a = 0; a < function.arguments.size(); ++a) {
            const TextureArgument& argument = function.arguments[a];
            const std::string own = std::string("n") + std::to_string(a);
            if (words_.at(descriptor(step, a)) >= 0) parameters += ", float4 " + own;
            expression = with_argument(expression, argument.type, a,
                                       value_of(step, a, name + "_" + own, own, tables));
        }
        return tables + "SHARED float4 " + name + "(TextureContext* tx" + parameters +
               ")\n{\n    TextureContext* tx_context = tx;\n"
               "    tx->budget = TEXTURE_BUDGET;\n    tx->first_occlusion = " +
               std::to_string(words_.at(step + 4)) + ";\n    (void)tx_context;\n    return " +
               expression + ";\n}\n";
    }

    // Argument `a` as an expression; arrays stand in a constant table called `table`.
    std::string value_of(int step, size_t a, const std::string& table, const std::string& parameter,
                         std::string& tables) const
    {
        const TextureArgument& argument = function_of(step).arguments[a];
        const int at = descriptor(step, a), first = words_.at(at + 1), length = words_.at(at + 2);
        if (words_.at(at) >= 0) return of_node(parameter, argument);
        if (!argument.is_array && argument.type != "sam2D") return element(words_, first, argument);
        const int stride = width_of(argument) == 3 ? 4 : width_of(argument);
        tables += "CONSTANT " + argument.type + " " + table + "[] = {";
        for (int e = 0; e < length; ++e)
            tables += (e > 0 ? ", " : "") + element(words_, first + e * stride, argument);
        tables += "};\n";
        if (!argument.is_array) return table + "[0]";
        return "tx_view_of_table_" + argument.type + "(" + table + ", " + std::to_string(length) +
               ")";
    }

    const SceneData& scene_;
    Words words_;
};

// Pages behind those that are there.
int append_words(SceneData& scene, const std::vector<int>& words)
{
    const size_t page_words = sizeof(Material) / sizeof(uint);
    const size_t first = scene.materials.size();
    scene.materials.resize(first + (words.size() + page_words - 1) / page_words);
    std::memcpy(static_cast<void*>(&scene.materials[first]), words.data(),
                words.size() * sizeof words[0]);
    return int(first * page_words);
}

// The steps' functions, when so many before them are gone.
void renumber(SceneData& scene, int program, int gone)
{
    auto* words = reinterpret_cast<char*>(scene.materials.data());
    const int steps = Words(scene).at(program);
    for (int k = 0; k < steps; ++k) {
        const int word = program + TEXTURE_PROGRAM_WORDS + k * TEXTURE_STEP_WORDS;
        const int function = Words(scene).at(word) - gone;
        std::memcpy(words + size_t(word) * sizeof function, &function, sizeof function);
    }
}

// A program of as many steps as it has results, none of which reads another. Returns its place.
int append_program(SceneData& scene, int old, const std::vector<Pasting::Result>& results,
                   int group)
{
    const Words words(scene);
    std::vector<int> program = {int(results.size()), group, words.at(old + 2), words.at(old + 3)};
    for (const Pasting::Result& result : results) {
        const int function = int(scene.textures.functions.size());
        program.insert(program.end(), {function, 0, -1, result.outputs, 0, 0, 0, 0});
        scene.textures.functions.push_back(result.function);
    }
    return append_words(scene, program);
}

// OpenCL reads programs path by path: functions in place of the words, so that one program alone
// becomes constants.
std::string constant_programs(const SceneData& scene, const std::vector<int>& programs)
{
    const Words words(scene);
    std::string counts, steps;
    for (const int word : programs) {
        const std::string at = std::to_string(word);
        const bool is_last = word == programs.back();
        const std::string guard = is_last ? "" : "    if (word == " + at + ") ";
        counts += (is_last ? "    " : guard) + "program.steps = " + std::to_string(words.at(word)) +
                  (is_last ? ";\n" : ";\n    else\n");
        for (int k = 0; k < words.at(word); ++k) {
            const int step = word + TEXTURE_PROGRAM_WORDS + k * TEXTURE_STEP_WORDS;
            const bool is_only = programs.size() == 1 && words.at(word) == 1;
            steps += (is_only ? "    {" : "    if (word == " + std::to_string(step) + ") {") +
                     " step.function = " + std::to_string(words.at(step)) +
                     "; step.outputs = " + std::to_string(words.at(step + 3)) + "; }\n";
        }
    }
    return "SHARED TextureProgram pasted_program(int word)\n{\n    TextureProgram program;\n"
           "    program.group = 0;\n    program.first = word + TEXTURE_PROGRAM_WORDS;\n" +
           counts +
           "    return program;\n}\n"
           "SHARED TextureStep pasted_step(int word)\n{\n    TextureStep step;\n"
           "    step.function = 0;\n    step.outputs = 0;\n    step.region = 0;\n"
           "    step.slot = -1;\n    step.first_occlusion = 0;\n"
           "    step.aov = -1;\n    step.distance = -1;\n" +
           steps +
           "    return step;\n}\n"
           "#define texture_program(scene, word) pasted_program(word)\n"
           "#define texture_step(scene, first, k) pasted_step((first) + (k) * "
           "TEXTURE_STEP_WORDS)\n";
}

void paste_arguments(SceneData& scene)
{
    std::vector<TextureFunction> own = scene.textures.functions;
    std::map<int, int> pasted;  // old places of programs and new ones
    std::vector<int> programs;
    for (size_t m = 0; m < size_t(scene.textures.first_page); ++m)
        for (size_t which = 0; which < std::size(scene.materials[m].texture_program); ++which) {
            const int word = scene.materials[m].texture_program[which];
            if (word == 0) continue;
            const auto [at, is_new] = pasted.try_emplace(word, 0);
            if (is_new) {
                const int group = int(pasted.size());
                at->second =
                    append_program(scene, word, Pasting(scene).program(word, group), group);
                programs.push_back(at->second);
            }
            scene.materials[m].texture_program[which] = at->second;
        }
    if (programs.empty()) return;
    // Behind the user's own functions, which the pasted ones call, in one text.
    std::string cpp, opencl;
    for (const TextureFunction& function : own) {
        cpp += function.cpp + "\n";
        opencl += function.opencl + "\n";
    }
    auto& functions = scene.textures.functions;
    functions.erase(functions.begin(), functions.begin() + long(own.size()));
    functions.front().cpp = cpp + functions.front().cpp;
    functions.front().opencl = opencl + functions.front().opencl;
    for (const int program : programs) renumber(scene, program, int(own.size()));
    functions.back().opencl += constant_programs(scene, programs);
    scene.textures.slots = 1;
}

}  // namespace

void make_texture_arm(SceneData& scene, TextureArm arm)
{
    if (scene.textures.functions.empty()) return;
    scene.textures.is_one_text = true;
    if (arm.pastes_arguments) paste_arguments(scene);
    if (!arm.traces_inside) return;
    scene.effects &= ~unsigned(EFFECT_TEXTURE_OCCLUSION);
    TextureFunction& first = scene.textures.functions.front();
    for (std::string* text : {&first.cpp, &first.opencl})
        *text = "#define tx_occlusion tx_traced_occlusion\n" + *text;
}

}  // namespace diptych
