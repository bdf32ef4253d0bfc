// Procedural textures: which are used and what they ask of the scene, and the pages behind the
// materials with their programs and arguments (common/textures/procedural.h).
#include "host/scene/scene_assembly.hpp"
#include "host/scene/texture_arguments.hpp"
#include "host/scene/texture_graph.hpp"

#include "common/textures/procedural.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstring>
#include <fmt/format.h>
#include <limits>
#include <optional>

namespace diptych {
namespace {

constexpr size_t page_words = sizeof(Material) / sizeof(uint);
constexpr int request_words = 4;
static_assert(sizeof(Material) == MATERIAL_WORDS * sizeof(uint));
static_assert(offsetof(Material, texture_program) == MATERIAL_PROGRAM_WORD * sizeof(uint));

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
    roots.insert(roots.end(), builder_.aovs_.begin(), builder_.aovs_.end());
    node_used_.assign(nodes.size(), 0);
    for (const GraphStep& step : texture_order(nodes, roots).steps) {
        node_used_[size_t(step.node)] = 1;
        const int function = nodes[size_t(step.node)].function;
        attributes_ |= builder_.texture_functions_[size_t(function)].attributes;
    }
    any_tangents_ = (attributes_ & (ATTRIBUTE_Tangent | ATTRIBUTE_Bitangent)) != 0;
}

namespace {

// What a program's steps are for beside each other: nodes by the place that their result has there.
struct Purpose {
    std::map<int, int> outputs{};  // masks over the results that other stages read
    std::vector<int> aovs{};       // layers of the picture
    std::vector<int> distances{};  // of occlusion
};

// Of a list, from 1 on; 0: not in it.
int number_in(const std::vector<int>& nodes, int node)
{
    const auto at = std::ranges::find(nodes, node);
    return at == nodes.end() ? 0 : int(at - nodes.begin()) + 1;
}

// The program of one material while it is put together.
struct MaterialProgram {
    struct Request {
        const OcclusionRequest* asked;
        std::optional<int> distance_word{};  // none: the request's own constant
    };
    std::vector<std::array<int, TEXTURE_STEP_WORDS>> steps;  // as they are stored
    std::vector<Request> requests;
    std::map<int, int> slot_of;  // by node
    std::vector<int> group;      // what programs that run side by side have in common
};

}  // namespace

// Writes the pages behind the materials: for each material that reads nodes, the regions of the
// nodes' arguments, then the program.
class SceneAssembly::TexturePages {
public:
    explicit TexturePages(SceneAssembly& assembly)
        : assembly_(assembly), textures_(assembly.data_.textures),
          pages_(assembly.data_.materials.size())
    {
        const TextureSettings& settings = assembly.builder_.texture_settings_;
        default_distance_ = settings.occlusion_distance > 0
                                ? settings.occlusion_distance
                                : 0.1 * double(assembly.data_.settings[0].scene_radius);
    }

    // The frames of all placements, for textures that ask for positions in an object's own space.
    int add_object_frames()
    {
        const int first = pages_.begin();
        for (const SceneBuilder::Placement& placement : assembly_.builder_.placements_) {
            const Transform to_object = inverse(placement.to_world);
            for (const auto& row : to_object.row)
                for (const double value : row) pages_.add(value);
        }
        return first;
    }

    // A program of material `m` (-1: of all), for the nodes `roots`. Returns its place. Nodes that
    // give its requests their distances are added to `distances`.
    int add(int m, const std::vector<int>& roots, const Purpose& purpose,
            std::vector<int>& distances)
    {
        const GraphProgram order = texture_order(assembly_.builder_.texture_nodes_, roots);
        textures_.slots = std::max(textures_.slots, order.slots);
        MaterialProgram program;
        for (const GraphStep& step : order.steps) add_step(m, step, purpose, distances, program);
        textures_.occlusion_results =
            std::max(textures_.occlusion_results, int(program.requests.size()));
        return add_program(program);
    }

    // The program that gives these distances; 0 where there are none.
    int add_distances(int m, const std::vector<int>& distances)
    {
        if (distances.empty()) return 0;
        textures_.distances = std::max(textures_.distances, int(distances.size()));
        std::vector<int> none;  // add_requests refuses what would ask for more
        return add(m, distances, {.distances = distances}, none);
    }

    void finish() { pages_.append_to(assembly_.data_.materials); }

private:
    void add_step(int m, const GraphStep& step, const Purpose& purpose, std::vector<int>& distances,
                  MaterialProgram& program)
    {
        const TextureNode& node = assembly_.builder_.texture_nodes_[size_t(step.node)];
        const TextureFunction& function =
            assembly_.builder_.texture_functions_[size_t(node.function)];
        program.slot_of[step.node] = step.slot;
        const int region = pages_.begin();
        const std::vector<int> value_words = add_region(region, node, function, program);
        const int first_request = int(program.requests.size());
        add_requests(node, function, value_words, distances, program);
        const auto output = purpose.outputs.find(step.node);
        const int outputs = output == purpose.outputs.end() ? 0 : output->second;
        const int aov = number_in(purpose.aovs, step.node);
        const int distance = number_in(purpose.distances, step.node);
        program.steps.push_back(
            {node.function, region, step.slot, outputs, first_request, aov, distance});
        program.group.insert(program.group.end(),
                             {node.function, step.slot, first_request, outputs, aov, distance});
        const int words =
            (pages_.end() - region + int(page_words) - 1) / int(page_words) * int(page_words);
        textures_.attachments.push_back({node.name, m, node.function, region, words, step.node});
    }

    // Where the value of each argument lies, by its position; -1: in the stack.
    std::vector<int> add_region(int region, const TextureNode& node,
                                const TextureFunction& function, const MaterialProgram& program)
    {
        std::vector<int> value_words;
        for (size_t a = 0; a < function.arguments.size() * TEXTURE_DESCRIPTOR_WORDS; ++a)
            pages_.add(0);
        for (size_t a = 0; a < function.arguments.size(); ++a) {
            const TextureArgument& argument = function.arguments[a];
            const TextureInput& value = node.arguments.at(argument.name);
            const int at = region + int(a) * TEXTURE_DESCRIPTOR_WORDS;
            pages_.align();
            const int first = value.node >= 0 ? region : pages_.end();
            value_words.push_back(value.node >= 0 ? -1 : first);
            size_t length = value.images.size();
            if (argument.type == "sam2D") {
                for (const TextureUse& use : value.images)
                    pages_.add(use.image < 0
                                   ? uint(-1)  // as is what no one sets: white
                                   : uint(assembly_.add_image_slot(use, !value.is_linear, 0)));
            } else {
                length = value.numbers.size() / size_t(width_of(argument));
                for (const uint word : constant_words(argument, value.numbers)) pages_.add(word);
            }
            pages_[at] = uint(value.node >= 0 ? program.slot_of.at(value.node) : -1);
            pages_[at + 1] = uint(first);
            pages_[at + 2] = uint(length);
        }
        pages_.align();
        return value_words;
    }

    void add_requests(const TextureNode& node, const TextureFunction& function,
                      const std::vector<int>& value_words, std::vector<int>& distances,
                      MaterialProgram& program) const
    {
        for (const OcclusionRequest& request : function.occlusion) {
            if (request.distance_argument < 0) {
                program.requests.push_back({&request});
                continue;
            }
            const size_t k = size_t(request.distance_argument);
            if (value_words[k] >= 0) {
                program.requests.push_back({&request, value_words[k]});
                continue;
            }
            const std::string& name = function.arguments[k].name;
            const int from = node.arguments.at(name).node;
            expect_no_occlusion(node, name, from);
            if (number_in(distances, from) == 0) distances.push_back(from);
            program.requests.push_back({&request, -number_in(distances, from)});  // ~ of it from 0
        }
    }

    // Of what gives the distance that argument `name` of the node is: it runs before any occlusion.
    void expect_no_occlusion(const TextureNode& node, const std::string& name, int from) const
    {
        const auto& nodes = assembly_.builder_.texture_nodes_;
        for (const GraphStep& step : texture_order(nodes, {from}).steps) {
            const TextureNode& other = nodes[size_t(step.node)];
            if (assembly_.builder_.texture_functions_[size_t(other.function)].occlusion.empty())
                continue;
            const std::string way =
                step.node == from ? ""
                                  : fmt::format("{}, which reads node ", nodes[size_t(from)].name);
            fail(node, fmt::format("the distance of its occlusion, {}, comes from node {}{}, which "
                                   "asks for occlusion itself; let it come from nodes that do not",
                                   name, way, other.name));
        }
    }

    // Returns the program's first word.
    int add_program(const MaterialProgram& program)
    {
        const int group = groups_.try_emplace(program.group, int(groups_.size())).first->second;
        const int header = pages_.begin();
        const int first_request =
            header + TEXTURE_PROGRAM_WORDS + int(program.steps.size()) * TEXTURE_STEP_WORDS;
        const int constants = first_request + int(program.requests.size()) * request_words;
        for (const int word :
             {int(program.steps.size()), group, first_request, int(program.requests.size())})
            pages_.add(word);
        for (const auto& step : program.steps)
            for (const int word : step) pages_.add(word);
        for (size_t k = 0; k < program.requests.size(); ++k) {
            pages_.add(program.requests[k].distance_word.value_or(constants + 1 + int(k)));
            pages_.add(int(program.requests[k].asked->hemisphere));
            pages_.add(program.requests[k].asked->is_same_object ? 1 : 0);
            pages_.add(constants);
        }
        pages_.add(default_distance_);
        for (const auto& request : program.requests) pages_.add(request.asked->distance);
        return header;
    }

    SceneAssembly& assembly_;
    SceneTextures& textures_;
    Pages pages_;
    std::map<std::vector<int>, int> groups_;
    double default_distance_ = 0;
};

// The nodes that layers show are run on whatever a path has met first: one program for all
// materials.
void SceneAssembly::assemble_aovs(TexturePages& pages)
{
    std::vector<int> distances;
    const int program = pages.add(-1, builder_.aovs_, {.aovs = builder_.aovs_}, distances);
    const int before = pages.add_distances(-1, distances);
    for (Material& material : data_.materials) {
        material.texture_program[PROGRAM_AOV] = program;
        material.texture_program[PROGRAM_AOV_DISTANCE] = before;
    }
    SceneTextures& textures = data_.textures;
    for (const int node : builder_.aovs_) {
        const TextureNode& shown = builder_.texture_nodes_[size_t(node)];
        const TextureFunction& function = builder_.texture_functions_[size_t(shown.function)];
        textures.aovs.push_back({shown.name, function.channels});
    }
    textures.outputs = std::max(textures.outputs, 1);  // what surfaces read in vain
    data_.effects |= EFFECT_TEXTURE_AOV;
}

// Behind the materials: a program for each that reads nodes, a region for each node it uses.
void SceneAssembly::assemble_textures()
{
    SceneTextures& textures = data_.textures;
    Settings& settings = data_.settings[0];
    std::ranges::fill(settings.texture_output, -1);
    settings.texture_uv_set[0] = uv_slots_[0];
    settings.texture_uv_set[1] = uv_slots_[1];
    settings.occlusion_rays = std::clamp(builder_.texture_settings_.occlusion_rays, 1, 256);
    settings.time = float(builder_.texture_settings_.time);
    settings.object_frames = -1;
    settings.aov_count = int(builder_.aovs_.size());
    textures.first_page = int(data_.materials.size());
    if (std::ranges::find(node_used_, 1) == node_used_.end()) return;

    textures.functions = builder_.texture_functions_;
    textures.attributes = attributes_;
    for (const TextureNode& node : builder_.texture_nodes_)
        textures.nodes.push_back({node.name, node.function, node.values});
    TexturePages pages(*this);
    if ((attributes_ & ATTRIBUTE_LocalPos) != 0) settings.object_frames = pages.add_object_frames();
    for (size_t m = 0; m < builder_.materials_.size(); ++m) {
        if (!is_used(int(m))) continue;
        const Material& material = data_.materials[m];
        const int packed[SLOT_COUNT] = {material.base_slot,     material.metallic_roughness_slot,
                                        material.normal_slot,   material.emission_slot,
                                        material.specular_slot, material.specular_color_slot};
        std::vector<int> roots, distances;
        Purpose surface;
        const auto slots = slots_of(builder_.materials_[m]);
        for (size_t s = 0; s < SLOT_COUNT; ++s) {
            if (packed[s] != TEXTURE_PROCEDURAL) continue;
            int& output = settings.texture_output[s];
            if (output < 0) output = textures.outputs++;
            roots.push_back(slots[s]->node);
            surface.outputs[slots[s]->node] |= 1 << output;
        }
        if (roots.empty()) continue;
        int* programs = data_.materials[m].texture_program;
        programs[PROGRAM_SURFACE] = pages.add(int(m), roots, surface, distances);
        const auto look_up_alone = [&](int which, size_t slot, unsigned effect) {
            const int root = slots[slot]->node;
            const Purpose alone{.outputs = {{root, 1 << settings.texture_output[slot]}}};
            programs[which] = roots.size() > 1 ? pages.add(int(m), {root}, alone, distances)
                                               : programs[PROGRAM_SURFACE];
            textures.records = 1;
            data_.effects |= effect;
        };
        if (packed[SLOT_EMISSION] == TEXTURE_PROCEDURAL)
            look_up_alone(PROGRAM_EMISSION, SLOT_EMISSION, EFFECT_PROCEDURAL_EMISSION);
        if (packed[SLOT_BASE] == TEXTURE_PROCEDURAL && material.alpha_mode != ALPHA_OPAQUE)
            look_up_alone(PROGRAM_ALPHA, SLOT_BASE, EFFECT_PROCEDURAL_ALPHA);
        programs[PROGRAM_DISTANCE] = pages.add_distances(int(m), distances);
    }
    if (!builder_.aovs_.empty()) assemble_aovs(pages);
    pages.finish();
    if (textures.distances > 0) data_.effects |= EFFECT_OCCLUSION_DISTANCE;
    data_.effects |= EFFECT_PROCEDURAL;
    if (textures.occlusion_results > 0) data_.effects |= EFFECT_TEXTURE_OCCLUSION;
    data_.effects &= ~builder_.disabled_effects_;
}

}  // namespace diptych
