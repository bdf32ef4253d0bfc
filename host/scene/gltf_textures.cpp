// The extension DIPTYCH_procedural_texture (docs/textures.md), and the same from the command line.
#include "host/scene/gltf_loader.hpp"

#include "backends/textures/texture_tool.hpp"
#include "host/scene/texture_arguments.hpp"
#include "host/scene/texture_graph.hpp"
#include "host/scene/texture_solo.hpp"
#include "host/scene/uri.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <set>

namespace diptych {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr const char* extension_name = "DIPTYCH_procedural_texture";
constexpr size_t most_nodes = 1 << 16;

// A slot by its key in the extension and by its name on the command line.
struct SlotName {
    const char* key;
    const char* flag;
    TextureUse MaterialInput::*use;
};
constexpr SlotName slot_names[] = {
    {"baseColorTexture", "baseColor", &MaterialInput::base_texture},
    {"metallicRoughnessTexture", "metallicRoughness", &MaterialInput::metallic_roughness_texture},
    {"normalTexture", "normal", &MaterialInput::normal_texture},
    {"emissiveTexture", "emissive", &MaterialInput::emission_texture},
    {"specularTexture", "specular", &MaterialInput::specular_texture},
    {"specularColorTexture", "specularColor", &MaterialInput::specular_color_texture},
};

[[noreturn]] void fail(const std::string& where, const std::string& what)
{
    throw SceneError(where + ": " + what);
}

void expect_object(const json& value, const std::string& where,
                   std::initializer_list<const char*> keys)
{
    if (!value.is_object()) fail(where, "must be an object; repair the file");
    for (const auto& [key, ignored] : value.items()) {
        if (std::ranges::find(keys, key) == keys.end()) {
            fail(where, fmt::format("has no property {}; it may have: {}", printable(key),
                                    fmt::join(keys, ", ")));
        }
    }
}

std::string text_of(const json& holder, const char* key, const std::string& where)
{
    const auto at = holder.find(key);
    if (at == holder.end()) return "";
    if (!at->is_string()) fail(where + "." + key, "must be a string; repair the file");
    return at->get<std::string>();
}

const json& array_of(const json& holder, const char* key, const std::string& where)
{
    static const json none = json::array();
    const auto at = holder.find(key);
    if (at == holder.end()) return none;
    if (!at->is_array()) fail(where + "." + key, "must be an array; repair the file");
    return *at;
}

double number_in(const json& value, const std::string& where)
{
    if (value.is_boolean()) return value.get<bool>() ? 1 : 0;
    if (!value.is_number() || !std::isfinite(value.get<double>()))
        fail(where, "must be a finite number");
    return value.get<double>();
}

}  // namespace

// Gathers sources, nodes and materials' slots, and has the tool translate what the nodes call.
class TextureReader {
public:
    TextureReader(GltfDocument& document, const LoadOptions& options,
                  std::vector<MaterialInput>& materials)
        : document_(document), options_(options), materials_(materials)
    {
    }

    void read()
    {
        if (!document_.textures().is_null()) read_document(document_.textures());
        for (size_t m = 0; m < materials_.size(); ++m) read_material(int(m));
        for (const std::string& flag : options_.textures) read_flag(flag);
        for (const std::string& flag : options_.texture_values) read_value(flag);
        if (entries_.size() > most_nodes)
            fail("texture nodes", fmt::format("{} are more than the {} that can be had",
                                              entries_.size(), most_nodes));
    }

    // A node as it stands in the file.
    struct Entry {
        std::string name;
        fs::path file;
        std::string function;
        json arguments = json::object();
    };
    const std::vector<Entry>& entries() const { return entries_; }
    TextureSettings settings;

    // The function of a node, translated once however many nodes call it.
    int function_of(const Entry& entry, SceneBuilder& scene)
    {
        const auto key = std::make_pair(entry.file.string(), entry.function);
        if (const auto at = functions_.find(key); at != functions_.end()) return at->second;
        const std::string id = fmt::format("t{}", functions_.size());
        const std::string shown = fs::absolute(entry.file).lexically_normal().string();
        TextureFunction function;
        try {
            function = translate_texture({entry.file, shown, entry.function, id});
            function.asked = entry.function;
        } catch (const std::runtime_error& error) {
            throw SceneError(fmt::format("texture node {}: {}", entry.name, error.what()));
        }
        auto& defaults = defaults_[int(functions_.size())];
        auto& taken = taken_[int(functions_.size())];
        for (const TextureArgument& argument : function.arguments) {
            taken.insert(argument.name);
            if (auto value = default_of(argument)) defaults[argument.name] = std::move(*value);
        }
        for (const std::string& warning : function.warnings) scene.notice(warning);
        return functions_[key] = scene.add_texture_function(std::move(function));
    }

    // What the file says an argument is where a node gives none, by name.
    const std::map<std::string, json>& defaults_of(int function) const
    {
        return defaults_.at(function);
    }

    // What the node is given, in the file and by flags.
    json arguments_of(const Entry& entry, int function) const
    {
        json arguments = entry.arguments;
        for (const std::string& text : options_.typed_values) {
            TextureValue set = parse_texture_value(text, printable(text));
            if (set.node == entry.name && taken_.at(function).contains(set.argument))
                arguments[set.argument] = std::move(set.value);
        }
        return arguments;
    }

private:
    fs::path source_file(const json& source, const std::string& where) const
    {
        expect_object(source, where, {"uri", "library", "name", "extras"});
        const std::string uri = text_of(source, "uri", where);
        const std::string library = text_of(source, "library", where);
        if (uri.empty() == library.empty()) fail(where, "must have either a uri or a library");
        const fs::path file =
            uri.empty() ? library_texture(library) : document_.resolved(uri, where);
        if (file.empty())
            fail(where, fmt::format("the library has no texture {}; see its list in "
                                    "docs/texture-library.md",
                                    printable(library)));
        if (!fs::is_regular_file(file))
            fail(where, fmt::format("{} is not there; check the name", printable(uri)));
        return file;
    }

    void read_document(const json& extension)
    {
        const std::string where = extension_name;
        expect_object(extension, where,
                      {"sources", "nodes", "occlusionRays", "occlusionDistance", "time", "extras"});
        std::vector<fs::path> files;
        for (const json& source : array_of(extension, "sources", where))
            files.push_back(
                source_file(source, fmt::format("{}.sources[{}]", where, files.size())));
        std::map<std::string, size_t> first_named;
        for (const json& node : array_of(extension, "nodes", where)) {
            const std::string at = fmt::format("{}.nodes[{}]", where, entries_.size());
            expect_object(node, at, {"name", "source", "function", "arguments", "extras"});
            const json source = node.value("source", json());
            if (!source.is_number_unsigned() || source.get<std::uint64_t>() >= files.size())
                fail(at + ".source", fmt::format("must name one of the {} sources", files.size()));
            Entry entry;
            entry.name = printable(text_of(node, "name", at));
            if (entry.name.empty()) entry.name = fmt::format("node {}", entries_.size());
            const auto [first, is_new] = first_named.try_emplace(entry.name, entries_.size());
            if (!is_new)
                fail(at + ".name", fmt::format("{} is the name of nodes[{}] too; give one of them "
                                               "another",
                                               entry.name, first->second));
            entry.file = files[source.get<size_t>()];
            entry.function = text_of(node, "function", at);
            if (node.contains("arguments")) entry.arguments = node["arguments"];
            if (!entry.arguments.is_object()) fail(at + ".arguments", "must be an object");
            entries_.push_back(std::move(entry));
        }
        if (extension.contains("occlusionRays")) {
            const double rays = number_in(extension["occlusionRays"], where + ".occlusionRays");
            if (rays < 1 || rays > 256 || rays != std::floor(rays))
                fail(where + ".occlusionRays", "must be a whole number from 1 to 256");
            settings.occlusion_rays = int(rays);
        }
        if (extension.contains("occlusionDistance")) {
            settings.occlusion_distance =
                number_in(extension["occlusionDistance"], where + ".occlusionDistance");
            if (settings.occlusion_distance < 0)
                fail(where + ".occlusionDistance",
                     "must not be negative; 0 is a tenth of the scene's radius");
        }
        if (extension.contains("time"))
            settings.time = number_in(extension["time"], where + ".time");
    }

    void read_material(int m)
    {
        if (m >= document_.material_count() || document_.textures_of(m).is_null()) return;
        const std::string where = fmt::format("materials[{}].extensions.{}", m, extension_name);
        const json& slots = document_.textures_of(m);
        if (!slots.is_object()) fail(where, "must be an object; repair the file");
        for (const auto& [key, use] : slots.items()) {
            const std::string& wanted = key;
            const auto at = std::ranges::find_if(
                slot_names, [&](const SlotName& s) { return wanted == s.key; });
            if (at == std::end(slot_names))
                fail(where, fmt::format("has no slot {}; slots are baseColorTexture, "
                                        "metallicRoughnessTexture, normalTexture, "
                                        "emissiveTexture, specularTexture, specularColorTexture",
                                        printable(key)));
            expect_object(use, where + "." + key, {"node", "extras"});
            if (!use.contains("node")) fail(where + "." + key, "its node is missing; name one");
            set_node(materials_[size_t(m)], at->use,
                     texture_node_named(use["node"], entries_, where + "." + key + ".node"));
        }
    }

    static void set_node(MaterialInput& material, TextureUse MaterialInput::*slot, int node)
    {
        material.*slot = {};
        (material.*slot).node = node;
        // A factor of zero would hide what was asked for.
        if (slot == &MaterialInput::emission_texture &&
            std::ranges::all_of(material.emission, [](float c) { return c == 0; }))
            material.emission = {1, 1, 1};
    }

    // MATERIAL.SLOT=FILE.c[:FUNCTION]
    void read_flag(const std::string& flag)
    {
        const std::string where = "--texture " + printable(flag);
        const size_t equals = flag.find('=');
        const size_t dot = flag.rfind('.', equals);
        if (equals == std::string::npos || dot == std::string::npos || dot == 0)
            fail(where, "not a texture; give MATERIAL.SLOT=FILE.c, with :FUNCTION if need be");
        const std::string slot_flag = flag.substr(dot + 1, equals - dot - 1);
        const auto slot = std::ranges::find_if(
            slot_names, [&](const SlotName& s) { return slot_flag == s.flag; });
        if (slot == std::end(slot_names))
            fail(where, fmt::format("{} is no slot; use baseColor, metallicRoughness, normal, "
                                    "emissive, specular or specularColor",
                                    slot_flag));
        std::string file = flag.substr(equals + 1), function;
        if (const size_t colon = file.rfind(':'); colon != std::string::npos) {
            function = file.substr(colon + 1);
            file.resize(colon);
        }
        fs::path path = file;
        if (!fs::is_regular_file(path)) path = library_texture(file);
        if (path.empty()) fail(where, file + ": no such file, nor a texture of the library");
        const int node = node_for(path, function);
        bool is_found = false;
        const std::string wanted = flag.substr(0, dot);
        for (size_t m = 0; m < materials_.size(); ++m) {
            if (wanted != "*" && wanted != materials_[m].name && wanted != std::to_string(m))
                continue;
            set_node(materials_[m], slot->use, node);
            is_found = true;
        }
        if (is_found) return;
        std::vector<std::string> names;
        for (const MaterialInput& m : materials_) names.push_back(printable(m.name));
        if (names.size() > 12) names.resize(12);
        fail(where, fmt::format("the scene has no material {}; it has: {}", wanted,
                                fmt::join(names, ", ")));
    }

    // The node of an earlier flag for the same function, or a new one under the file's own name.
    int node_for(const fs::path& file, const std::string& function)
    {
        for (size_t k = first_flag_; k < entries_.size(); ++k)
            if (entries_[k].file == file && entries_[k].function == function) return int(k);
        std::string name = file.stem().string();
        while (std::ranges::find(entries_, name, &Entry::name) != entries_.end()) name += "_";
        entries_.push_back({name, file, function, json::object()});
        return int(entries_.size()) - 1;
    }

    // NODE.ARGUMENT=JSON
    void read_value(const std::string& flag)
    {
        const std::string where = "--set " + printable(flag);
        const TextureValue set = parse_texture_value(flag, where);
        entries_[size_t(texture_node_named(set.node, entries_, where))].arguments[set.argument] =
            set.value;
    }

    GltfDocument& document_;
    const LoadOptions& options_;
    std::vector<MaterialInput>& materials_;
    std::vector<Entry> entries_;
    size_t first_flag_ = 0;
    std::map<std::pair<std::string, std::string>, int> functions_;
    std::map<int, std::map<std::string, json>> defaults_;
    std::map<int, std::set<std::string>> taken_;  // arguments of each function
};

// Numbers, images or a node: an array gives its elements one after the other.
TextureInput GltfLoader::texture_input(const nlohmann::json& value, const TextureReader& reader,
                                       const std::string& where, int depth) const
{
    TextureInput input;
    if (value.is_string()) {
        if (value != "white")
            fail(where, "must be numbers, an image as {\"texture\": N} or \"white\", or a node");
        input.images.push_back({});  // none is white
    } else if (const auto numbers = constant_numbers(value, where)) {
        input.numbers = *numbers;
    } else if (value.is_array()) {
        if (depth > 1) fail(where, "is nested too deeply; give an array of numbers or of vectors");
        for (const json& element : value) {
            const TextureInput one = texture_input(element, reader, where, depth + 1);
            if (one.node >= 0) fail(where, "nodes in arrays are not supported; give numbers");
            input.numbers.insert(input.numbers.end(), one.numbers.begin(), one.numbers.end());
            input.images.insert(input.images.end(), one.images.begin(), one.images.end());
            input.is_linear |= one.is_linear;
        }
    } else if (value.is_object() && value.contains("node")) {
        expect_object(value, where, {"node"});
        input.node = texture_node_named(value["node"], reader.entries(), where);
    } else {
        expect_object(value, where, {"texture", "colorSpace"});
        const json texture = value.value("texture", json());
        if (!texture.is_number_unsigned() || texture.get<std::uint64_t>() >= model_.textures.size())
            fail(where, fmt::format("must name one of the {} textures of the file, or a node",
                                    model_.textures.size()));
        const std::string space = text_of(value, "colorSpace", where);
        if (!space.empty() && space != "srgb" && space != "linear")
            fail(where + ".colorSpace", "must be srgb or linear");
        input.is_linear = space == "linear";
        input.images.push_back(texture_use(texture.get<int>(), 0, {}));
    }
    return input;
}

void GltfLoader::add_textures()
{
    TextureReader reader(document_, options_, materials_);
    reader.read();
    scene_.set_textures(reader.settings);
    for (const TextureReader::Entry& entry : reader.entries()) {
        TextureNode node;
        node.name = entry.name;
        node.function = reader.function_of(entry, scene_);
        const auto give = [&](const std::string& name, const json& value, const char* what) {
            node.arguments[name] = texture_input(
                value, reader,
                fmt::format("texture node {}: {} {}", entry.name, what, printable(name)), 0);
            node.values[name] = dumped(value);
        };
        const json arguments = reader.arguments_of(entry, node.function);
        for (const auto& [name, value] : arguments.items()) give(name, value, "argument");
        for (const auto& [name, value] : reader.defaults_of(node.function))
            if (!node.arguments.count(name)) give(name, value, "default of");
        texture_nodes_.push_back(std::move(node));
    }
    if (!options_.solo.empty()) show_only(options_.solo, texture_nodes_, materials_);
    for (const std::string& name : options_.aovs)
        scene_.add_aov(texture_node_named(name, texture_nodes_, "--aov"));
}

}  // namespace diptych
