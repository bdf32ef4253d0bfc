// Procedural textures: which are used and what they ask of the scene, and the pages behind the
// materials with their programs and arguments (common/textures/procedural.h).
#include "host/scene/scene_assembly.hpp"
#include "host/scene/texture_graph.hpp"

#include "common/textures/procedural.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <fmt/format.h>
#include <limits>

namespace diptych {
namespace {

constexpr size_t page_words = sizeof(Material) / sizeof(uint);
constexpr int request_words = 4;

int width_of(const std::string& type)
{
    return std::isdigit(static_cast<unsigned char>(type.back())) && type != "sam2D"
               ? type.back() - '0'
               : 1;
}

// Words from one element of an array to the next: those of three take four.
int stride_of(const std::string& type) { return width_of(type) == 3 ? 4 : width_of(type); }

std::string shown(const TextureArgument& argument)
{
    if (!argument.is_array) return argument.type;
    return argument.length > 0 ? fmt::format("{}[{}]", argument.type, argument.length)
                               : argument.type + "[]";
}

// The words of the materials' buffer behind the materials, page by page.
class Pages {
public:
    explicit Pages(size_t materials) : first_(materials * page_words) {}

    // Begins on a new page.
    int begin()
    {
        words_.resize((words_.size() + page_words - 1) / page_words * page_words, 0);
        if (first_ + words_.size() > size_t(std::numeric_limits<int>::max()) - 0x100000) {
            throw SceneError("the scene: the arguments of its textures need more than 32-bit "
                             "indices reach; use fewer or shorter ones");
        }
        return int(first_ + words_.size());
    }
    int end() const { return int(first_ + words_.size()); }
    void align()
    {
        while (words_.size() % 4 != 0) words_.push_back(0);
    }
    void add(uint word) { words_.push_back(word); }
    void add(int word) { words_.push_back(uint(word)); }
    void add(double value) { words_.push_back(std::bit_cast<uint>(float(value))); }
    uint& operator[](int word) { return words_[size_t(word) - first_]; }

    void append_to(std::vector<Material>& materials)
    {
        begin();
        const size_t old = materials.size();
        materials.resize(old + words_.size() / page_words);
        if (!words_.empty()) {
            std::memcpy(static_cast<void*>(&materials[old]), words_.data(),
                        words_.size() * sizeof(uint));
        }
    }

private:
    size_t first_;
    std::vector<uint> words_;
};

[[noreturn]] void fail(const TextureNode& node, const std::string& what)
{
    throw SceneError(fmt::format("texture node {}: {}", node.name, what));
}

std::string argument_names(const TextureFunction& function)
{
    std::string names;
    for (const TextureArgument& argument : function.arguments)
        names += (names.empty() ? "" : ", ") + shown(argument) + " " + argument.name;
    return names.empty() ? "none" : names;
}

void check_numbers(const TextureNode& node, const TextureArgument& argument,
                   const TextureInput& value)
{
    const std::string at = fmt::format("its argument {} ", argument.name);
    const size_t width = size_t(width_of(argument.type));
    const size_t count = value.numbers.size();
    if (!value.images.empty() || value.node >= 0)
        fail(node, at + fmt::format("is of type {}; give it numbers", shown(argument)));
    if (argument.is_array ? count == 0 || count % width != 0 : count != width)
        fail(node,
             at + fmt::format("is of type {}, but has {} numbers; give it {}", shown(argument),
                              count, argument.is_array ? "whole elements" : std::to_string(width)));
    if (argument.is_array && argument.length > 0 && count / width != size_t(argument.length))
        fail(node, at + fmt::format("has {} elements; the function wants {}", count / width,
                                    argument.length));
    const bool is_whole = argument.type.starts_with("int") || argument.type.starts_with("uint");
    const double low = argument.type.starts_with("uint") ? 0 : -2147483648.0;
    const double high = argument.type.starts_with("uint") ? 4294967295.0 : 2147483647.0;
    for (const double x : value.numbers) {
        if (is_whole && !(x == std::floor(x) && x >= low && x <= high))
            fail(node,
                 at + fmt::format("is of type {}; {} is not such a number", argument.type, x));
        if (!is_whole && !std::isfinite(float(x)))
            fail(node, at + fmt::format("has the value {}, beyond the range of float", x));
    }
}

void check_argument(const TextureNode& node, const TextureArgument& argument,
                    const TextureInput& value)
{
    const std::string at = fmt::format("its argument {} ", argument.name);
    if (argument.type == "sam2D") {
        const size_t count = value.images.size();
        if (!value.numbers.empty() || value.node >= 0 || count == 0)
            fail(node, at + "is an image; name one with {\"texture\": N}");
        if (!argument.is_array && count != 1) fail(node, at + "is one image; name just one");
        if (argument.is_array && argument.length > 0 && count != size_t(argument.length))
            fail(node,
                 at + fmt::format("has {} images; the function wants {}", count, argument.length));
        return;
    }
    if (value.node < 0) return check_numbers(node, argument, value);
    if (argument.is_array || !argument.type.starts_with("float"))
        fail(node, at + fmt::format("is of type {}, which no node gives; give it {}",
                                    shown(argument), "numbers"));
}

void check_node(const TextureNode& node, const TextureFunction& function)
{
    for (const auto& [name, value] : node.arguments) {
        const auto at = std::ranges::find(function.arguments, name, &TextureArgument::name);
        if (at == function.arguments.end())
            fail(node, fmt::format("{} has no argument {}; it takes: {}", function.entry, name,
                                   argument_names(function)));
        check_argument(node, *at, value);
    }
    for (const TextureArgument& argument : function.arguments)
        if (!node.arguments.count(argument.name))
            fail(node, fmt::format("its argument {} {} is missing; give it a value",
                                   shown(argument), argument.name));
}

void add_constants(Pages& pages, const TextureArgument& argument, const TextureInput& value)
{
    const int width = width_of(argument.type), stride = stride_of(argument.type);
    const bool is_int = argument.type.starts_with("int"),
               is_uint = argument.type.starts_with("uint");
    for (size_t k = 0; k < value.numbers.size(); ++k) {
        const double x = value.numbers[k];
        if (is_int)
            pages.add(int(x));
        else if (is_uint)
            pages.add(uint(x));
        else
            pages.add(x);
        for (int pad = width; int(k % size_t(width)) == width - 1 && pad < stride; ++pad)
            pages.add(0);
    }
}

}  // namespace

std::array<const TextureUse*, SLOT_COUNT> SceneAssembly::slots_of(const MaterialInput& m)
{
    return {&m.base_texture,     &m.metallic_roughness_texture, &m.normal_texture,
            &m.emission_texture, &m.specular_texture,           &m.specular_color_texture};
}

// Before anything is assembled: what the textures in use ask of geometry and images.
void SceneAssembly::survey_textures()
{
    const auto& nodes = builder_.texture_nodes_;
    check_texture_graph(nodes);
    for (const TextureNode& node : nodes) {
        check_node(node, builder_.texture_functions_.at(size_t(node.function)));
    }
    std::vector<int> roots;
    for (size_t m = 0; m < builder_.materials_.size(); ++m) {
        for (const TextureUse* use : slots_of(builder_.materials_[m])) {
            if (use->node >= int(nodes.size())) {
                throw SceneError(fmt::format("material {}: names texture node {} of {}; name one "
                                             "that is there",
                                             builder_.materials_[m].name, use->node, nodes.size()));
            }
            if (is_used(int(m)) && use->node >= 0) roots.push_back(use->node);
        }
    }
    node_used_.assign(nodes.size(), 0);
    for (const GraphStep& step : texture_order(nodes, roots).steps) {
        node_used_[size_t(step.node)] = 1;
        const int function = nodes[size_t(step.node)].function;
        attributes_ |= builder_.texture_functions_[size_t(function)].attributes;
    }
    any_tangents_ = (attributes_ & (ATTRIBUTE_Tangent | ATTRIBUTE_Bitangent)) != 0;
}

// Behind the materials: a program for each that reads nodes, a region for each node it uses.
void SceneAssembly::assemble_textures()
{
    const auto& nodes = builder_.texture_nodes_;
    const auto& functions = builder_.texture_functions_;
    SceneTextures& textures = data_.textures;
    Settings& settings = data_.settings[0];
    std::ranges::fill(settings.texture_output, -1);
    settings.texture_uv_set[0] = uv_slots_[0];
    settings.texture_uv_set[1] = uv_slots_[1];
    settings.occlusion_rays = std::clamp(builder_.texture_settings_.occlusion_rays, 1, 256);
    settings.time = float(builder_.texture_settings_.time);
    const double asked = builder_.texture_settings_.occlusion_distance;
    const double default_distance = asked > 0 ? asked : 0.1 * double(settings.scene_radius);
    textures.first_page = int(data_.materials.size());
    if (std::ranges::find(node_used_, 1) == node_used_.end()) return;

    textures.functions = functions;
    textures.attributes = attributes_;
    Pages pages(data_.materials.size());
    std::map<std::vector<int>, int> groups;
    for (size_t m = 0; m < builder_.materials_.size(); ++m) {
        if (!is_used(int(m))) continue;
        Material& material = data_.materials[m];
        const int* const packed[SLOT_COUNT] = {
            &material.base_slot,     &material.metallic_roughness_slot,
            &material.normal_slot,   &material.emission_slot,
            &material.specular_slot, &material.specular_color_slot};
        std::vector<int> roots;
        std::map<int, int> outputs;  // of a node, a mask
        const auto slots = slots_of(builder_.materials_[m]);
        for (size_t s = 0; s < SLOT_COUNT; ++s) {
            if (*packed[s] != TEXTURE_PROCEDURAL) continue;
            int& output = settings.texture_output[s];
            if (output < 0) output = textures.outputs++;
            roots.push_back(slots[s]->node);
            outputs[slots[s]->node] |= 1 << output;
        }
        if (roots.empty()) continue;
        const GraphProgram program = texture_order(nodes, roots);
        textures.slots = std::max(textures.slots, program.slots);

        std::map<int, int> slot_of;
        std::vector<int> regions, group;
        struct Request {
            const OcclusionRequest* asked;
            int distance_word;
        };
        std::vector<Request> requests;
        std::vector<int> first_request;
        for (const GraphStep& step : program.steps) {
            const TextureNode& node = nodes[size_t(step.node)];
            const TextureFunction& function = functions[size_t(node.function)];
            slot_of[step.node] = step.slot;
            const int region = pages.begin();
            regions.push_back(region);
            std::vector<int> value_words;
            for (size_t a = 0; a < function.arguments.size() * TEXTURE_DESCRIPTOR_WORDS; ++a)
                pages.add(0);
            for (size_t a = 0; a < function.arguments.size(); ++a) {
                const TextureArgument& argument = function.arguments[a];
                const TextureInput& value = node.arguments.at(argument.name);
                const int at = region + int(a) * TEXTURE_DESCRIPTOR_WORDS;
                pages.align();
                const int first = value.node >= 0 ? region : pages.end();
                value_words.push_back(value.node >= 0 ? -1 : first);
                size_t length = value.images.size();
                if (argument.type == "sam2D") {
                    for (const TextureUse& use : value.images)
                        pages.add(add_image_slot(use, !value.is_linear, 0));
                } else {
                    length = value.numbers.size() / size_t(width_of(argument.type));
                    add_constants(pages, argument, value);
                }
                pages[at] = uint(value.node >= 0 ? slot_of[value.node] : -1);
                pages[at + 1] = uint(first);
                pages[at + 2] = uint(length);
            }
            pages.align();
            first_request.push_back(int(requests.size()));
            for (const OcclusionRequest& request : function.occlusion) {
                const int k = request.distance_argument;
                if (k >= 0 && value_words[size_t(k)] < 0)
                    fail(node,
                         fmt::format(
                             "the distance of its occlusion, {}, comes from node {}; "
                             "give it a number",
                             function.arguments[size_t(k)].name,
                             nodes[size_t(
                                       node.arguments.at(function.arguments[size_t(k)].name).node)]
                                 .name));
                requests.push_back({&request, k >= 0 ? value_words[size_t(k)] : -1});
            }
            group.insert(group.end(), {node.function, step.slot, first_request.back(),
                                       outputs.count(step.node) ? outputs[step.node] : 0});
            const int words =
                (pages.end() - region + int(page_words) - 1) / int(page_words) * int(page_words);
            textures.attachments.push_back({node.name, int(m), node.function, region, words});
        }
        const int group_number = groups.try_emplace(group, int(groups.size())).first->second;
        material.texture_program = pages.begin();
        const int header = material.texture_program;
        const int first_request_word =
            header + TEXTURE_PROGRAM_WORDS + int(program.steps.size()) * TEXTURE_STEP_WORDS;
        const int constants = first_request_word + int(requests.size()) * request_words;
        pages.add(int(program.steps.size()));
        pages.add(group_number);
        pages.add(first_request_word);
        pages.add(int(requests.size()));
        for (size_t k = 0; k < program.steps.size(); ++k) {
            const GraphStep& step = program.steps[k];
            const int words[TEXTURE_STEP_WORDS] = {
                nodes[size_t(step.node)].function, regions[k], step.slot,
                outputs.count(step.node) ? outputs[step.node] : 0, first_request[k]};
            for (const int word : words) pages.add(word);
        }
        for (size_t k = 0; k < requests.size(); ++k) {
            const int own = requests[k].distance_word;
            pages.add(own >= 0 ? own : constants + 1 + int(k));
            pages.add(int(requests[k].asked->hemisphere));
            pages.add(requests[k].asked->is_same_object ? 1 : 0);
            pages.add(constants);
        }
        pages.add(default_distance);
        for (const Request& request : requests) pages.add(request.asked->distance);
        textures.occlusion_results = std::max(textures.occlusion_results, int(requests.size()));
    }
    pages.append_to(data_.materials);
    data_.effects |= EFFECT_PROCEDURAL;
    if (textures.occlusion_results > 0) data_.effects |= EFFECT_TEXTURE_OCCLUSION;
    data_.effects &= ~builder_.disabled_effects_;
}

}  // namespace diptych
