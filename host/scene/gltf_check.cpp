#include "host/scene/gltf_check.hpp"

#include "host/scene/scene_error.hpp"

#include <cmath>
#include <cstring>
#include <fmt/format.h>
#include <map>

namespace diptych {
namespace {

using nlohmann::json;

enum Kind {
    text,
    texts,
    flag,
    number,
    numbers,   // `of` says how many
    whole,     // 0 or more, in 31 bits
    size,      // 0 or more, in 53 bits
    index_of,  // into the array `of`
    indices_of,
    index_map,  // any keys
    object,     // of the type `of`
    objects
};
enum Need { optional, required };

// One property of one type of object.
struct Row {
    const char* type;
    const char* key;
    Kind kind;
    const char* of;
    Need need = optional;
};

constexpr Row rows[] = {
    {"glTF", "asset", object, "asset", required},
    {"glTF", "extensionsUsed", texts, ""},
    {"glTF", "extensionsRequired", texts, ""},
    {"glTF", "scene", index_of, "scenes"},
    {"glTF", "scenes", objects, "scene"},
    {"glTF", "nodes", objects, "node"},
    {"glTF", "meshes", objects, "mesh"},
    {"glTF", "cameras", objects, "camera"},
    {"glTF", "materials", objects, "material"},
    {"glTF", "textures", objects, "texture"},
    {"glTF", "images", objects, "image"},
    {"glTF", "samplers", objects, "sampler"},
    {"glTF", "accessors", objects, "accessor"},
    {"glTF", "bufferViews", objects, "bufferView"},
    {"glTF", "buffers", objects, "buffer"},
    {"glTF", "extensions", object, "glTF extensions"},
    {"glTF extensions", "KHR_lights_punctual", object, "lights"},
    {"lights", "lights", objects, "light", required},
    {"asset", "version", text, "", required},
    {"asset", "minVersion", text, ""},
    {"scene", "name", text, ""},
    {"scene", "nodes", indices_of, "nodes"},
    {"node", "name", text, ""},
    {"node", "children", indices_of, "nodes"},
    {"node", "mesh", index_of, "meshes"},
    {"node", "camera", index_of, "cameras"},
    {"node", "matrix", numbers, "16"},
    {"node", "translation", numbers, "3"},
    {"node", "rotation", numbers, "4"},
    {"node", "scale", numbers, "3"},
    {"node", "extensions", object, "node extensions"},
    {"node extensions", "KHR_lights_punctual", object, "node light"},
    {"node extensions", "EXT_mesh_gpu_instancing", object, "instancing"},
    {"node light", "light", index_of, "lights", required},
    {"instancing", "attributes", index_map, "accessors", required},
    {"light", "name", text, ""},
    {"light", "type", text, "", required},
    {"light", "color", numbers, "3"},
    {"light", "intensity", number, ""},
    {"light", "range", number, ""},
    {"light", "spot", object, "spot"},
    {"spot", "innerConeAngle", number, ""},
    {"spot", "outerConeAngle", number, ""},
    {"mesh", "name", text, ""},
    {"mesh", "primitives", objects, "primitive", required},
    {"primitive", "attributes", index_map, "accessors", required},
    {"primitive", "indices", index_of, "accessors"},
    {"primitive", "material", index_of, "materials"},
    {"primitive", "mode", whole, ""},
    {"camera", "name", text, ""},
    {"camera", "type", text, "", required},
    {"camera", "perspective", object, "perspective"},
    {"camera", "orthographic", object, "orthographic"},
    {"perspective", "yfov", number, "", required},
    {"perspective", "aspectRatio", number, ""},
    {"perspective", "znear", number, "", required},
    {"perspective", "zfar", number, ""},
    {"orthographic", "xmag", number, "", required},
    {"orthographic", "ymag", number, "", required},
    {"orthographic", "znear", number, "", required},
    {"orthographic", "zfar", number, "", required},
    {"material", "name", text, ""},
    {"material", "pbrMetallicRoughness", object, "pbr"},
    {"material", "normalTexture", object, "normal texture"},
    {"material", "emissiveTexture", object, "texture info"},
    {"material", "emissiveFactor", numbers, "3"},
    {"material", "alphaMode", text, ""},
    {"material", "alphaCutoff", number, ""},
    {"material", "doubleSided", flag, ""},
    {"material", "extensions", object, "material extensions"},
    {"pbr", "baseColorFactor", numbers, "4"},
    {"pbr", "baseColorTexture", object, "texture info"},
    {"pbr", "metallicFactor", number, ""},
    {"pbr", "roughnessFactor", number, ""},
    {"pbr", "metallicRoughnessTexture", object, "texture info"},
    {"material extensions", "KHR_materials_unlit", object, "unlit"},
    {"material extensions", "KHR_materials_emissive_strength", object, "strength"},
    {"material extensions", "KHR_materials_ior", object, "ior"},
    {"material extensions", "KHR_materials_specular", object, "specular"},
    {"strength", "emissiveStrength", number, ""},
    {"ior", "ior", number, ""},
    {"specular", "specularFactor", number, ""},
    {"specular", "specularTexture", object, "texture info"},
    {"specular", "specularColorFactor", numbers, "3"},
    {"specular", "specularColorTexture", object, "texture info"},
    {"texture info", "index", index_of, "textures", required},
    {"texture info", "texCoord", whole, ""},
    {"texture info", "extensions", object, "texture info extensions"},
    {"normal texture", "index", index_of, "textures", required},
    {"normal texture", "texCoord", whole, ""},
    {"normal texture", "scale", number, ""},
    {"normal texture", "extensions", object, "texture info extensions"},
    {"texture info extensions", "KHR_texture_transform", object, "transform"},
    {"transform", "offset", numbers, "2"},
    {"transform", "rotation", number, ""},
    {"transform", "scale", numbers, "2"},
    {"transform", "texCoord", whole, ""},
    {"texture", "name", text, ""},
    {"texture", "source", index_of, "images"},
    {"texture", "sampler", index_of, "samplers"},
    {"texture", "extensions", object, "texture extensions"},
    {"texture extensions", "KHR_texture_basisu", object, "texture source"},
    {"texture extensions", "EXT_texture_webp", object, "texture source"},
    {"texture source", "source", index_of, "images"},
    {"image", "name", text, ""},
    {"image", "uri", text, ""},
    {"image", "bufferView", index_of, "bufferViews"},
    {"image", "mimeType", text, ""},
    {"sampler", "magFilter", whole, ""},
    {"sampler", "minFilter", whole, ""},
    {"sampler", "wrapS", whole, ""},
    {"sampler", "wrapT", whole, ""},
    {"accessor", "name", text, ""},
    {"accessor", "bufferView", index_of, "bufferViews"},
    {"accessor", "byteOffset", size, ""},
    {"accessor", "componentType", whole, "", required},
    {"accessor", "count", size, "", required},
    {"accessor", "type", text, "", required},
    {"accessor", "normalized", flag, ""},
    {"accessor", "sparse", object, "sparse"},
    {"sparse", "count", whole, "", required},
    {"sparse", "indices", object, "sparse indices", required},
    {"sparse", "values", object, "sparse values", required},
    {"sparse indices", "bufferView", index_of, "bufferViews", required},
    {"sparse indices", "byteOffset", whole, ""},
    {"sparse indices", "componentType", whole, "", required},
    {"sparse values", "bufferView", index_of, "bufferViews", required},
    {"sparse values", "byteOffset", whole, ""},
    {"bufferView", "name", text, ""},
    {"bufferView", "buffer", index_of, "buffers", required},
    {"bufferView", "byteOffset", size, ""},
    {"bufferView", "byteLength", size, "", required},
    {"bufferView", "byteStride", whole, ""},
    {"buffer", "name", text, ""},
    {"buffer", "uri", text, ""},
    {"buffer", "byteLength", size, "", required},
};

[[noreturn]] void fail(const std::string& where, const std::string& what)
{
    throw SceneError(where + ": " + what + "; repair the file");
}

class Checker {
public:
    explicit Checker(const json& document)
    {
        for (const Row& row : rows) {
            rows_of_[row.type].push_back(&row);
        }
        for (const Row* row : rows_of_.at("glTF")) {
            if (row->kind == objects) {
                note_size(document, row->key, row->key);
            }
        }
        const auto extensions = document.find("extensions");
        if (extensions == document.end() || !extensions->is_object()) {
            return;
        }
        const auto lights = extensions->find("KHR_lights_punctual");
        if (lights != extensions->end() && lights->is_object()) {
            note_size(*lights, "lights", "lights");
        }
    }

    // The recursion is as deep as the table, not as the document.
    json reduced(const json& value, const char* type, const std::string& where) const
    {
        if (!value.is_object()) {
            fail(where, "must be an object");
        }
        json result = json::object();
        for (const Row* row :
             rows_of_.count(type) ? rows_of_.at(type) : std::vector<const Row*>{}) {
            const std::string place = where.empty() ? row->key : where + "." + row->key;
            const auto at = value.find(row->key);
            if (at == value.end()) {
                if (row->need == required) {
                    fail(place, "is missing");
                }
                continue;
            }
            result[row->key] = checked(*at, *row, place);
        }
        return result;
    }

private:
    void note_size(const json& holder, const char* key, const char* name)
    {
        const auto at = holder.find(key);
        if (at != holder.end() && at->is_array()) {
            sizes_[name] = at->size();
        }
    }

    json checked(const json& value, const Row& row, const std::string& where) const
    {
        switch (row.kind) {
        case text:
            if (!value.is_string()) {
                fail(where, "must be a string");
            }
            return value;
        case texts:
            return each(value, where, [&](const json& v, const std::string& place) {
                if (!v.is_string()) {
                    fail(place, "must be a string");
                }
                return v;
            });
        case flag:
            if (!value.is_boolean()) {
                fail(where, "must be true or false");
            }
            return value;
        case number:
            return checked_number(value, where);
        case numbers: {
            const size_t count = size_t(std::atoi(row.of));
            if (!value.is_array() || value.size() != count) {
                fail(where, fmt::format("must be {} numbers", count));
            }
            return each(value, where, [&](const json& v, const std::string& place) {
                return checked_number(v, place);
            });
        }
        case whole:
            return checked_whole(value, where, 2147483647.0);
        case size:
            return checked_whole(value, where, 9007199254740992.0);
        case index_of:
            return checked_index(value, row.of, where);
        case indices_of:
            return each(value, where, [&](const json& v, const std::string& place) {
                return checked_index(v, row.of, place);
            });
        case index_map: {
            if (!value.is_object()) {
                fail(where, "must be an object");
            }
            json result = json::object();
            for (const auto& [key, v] : value.items()) {
                result[key] = checked_index(v, row.of, where + "." + key);
            }
            return result;
        }
        case object:
            return reduced(value, row.of, where);
        case objects:
            return each(value, where, [&](const json& v, const std::string& place) {
                return reduced(v, row.of, place);
            });
        }
        return {};
    }

    template<typename Check>
    json each(const json& value, const std::string& where, Check check) const
    {
        if (!value.is_array()) {
            fail(where, "must be an array");
        }
        json result = json::array();
        for (size_t k = 0; k < value.size(); ++k) {
            result.push_back(check(value[k], fmt::format("{}[{}]", where, k)));
        }
        return result;
    }

    json checked_number(const json& value, const std::string& where) const
    {
        if (!value.is_number() || !std::isfinite(value.get<double>())) {
            fail(where, "must be a finite number");
        }
        return value.get<double>();
    }

    // Some exporters write whole numbers as 3.0, which JSON does not tell from 3.
    json checked_whole(const json& value, const std::string& where, double most) const
    {
        const double as_double = value.is_number() ? value.get<double>() : -1;
        if (as_double < 0 || as_double != std::floor(as_double) || as_double > most) {
            fail(where, fmt::format("must be a whole number from 0 to {:.0f}", most));
        }
        return std::uint64_t(as_double);
    }

    json checked_index(const json& value, const char* array, const std::string& where) const
    {
        const auto index = checked_whole(value, where, 2147483647.0).get<std::uint64_t>();
        const auto at = sizes_.find(array);
        const size_t size = at == sizes_.end() ? 0 : at->second;
        if (index >= size) {
            fail(where, fmt::format("names {} of {} {}", index, size, array));
        }
        return index;
    }

    std::map<std::string, std::vector<const Row*>> rows_of_;
    std::map<std::string, size_t> sizes_;
};

std::uint64_t whole_or(const json& value, const char* key, std::uint64_t fallback)
{
    return value.contains(key) ? value[key].get<std::uint64_t>() : fallback;
}

size_t component_size(int component_type)
{
    switch (component_type) {
    case 5120:
    case 5121:
        return 1;
    case 5122:
    case 5123:
        return 2;
    case 5125:
    case 5126:
        return 4;
    default:
        return 0;
    }
}

size_t component_count(const std::string& type)
{
    constexpr std::pair<const char*, size_t> counts[] = {{"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3},
                                                         {"VEC4", 4},   {"MAT2", 4}, {"MAT3", 9},
                                                         {"MAT4", 16}};
    for (const auto& [name, count] : counts) {
        if (type == name) {
            return count;
        }
    }
    return 0;
}

// `count` elements of `size` bytes every `stride` bytes, from `offset` on: they must fit the view.
// The numbers are below 2^53 and 2^8, so that a double cannot be fooled by overflow.
void check_fit(const json& document, std::uint64_t view, double offset, double count, double size,
               double stride, const std::string& where)
{
    const double length = double(whole_or(document["bufferViews"][view], "byteLength", 0));
    const double end = offset + (count > 0 ? stride * (count - 1) + size : 0);
    if (end > length) {
        fail(where,
             fmt::format("{} elements of {} bytes end at byte {} of buffer view {}, which has "
                         "{} bytes",
                         std::uint64_t(count), std::uint64_t(size), std::uint64_t(end), view,
                         std::uint64_t(length)));
    }
}

void check_buffer_views(const json& document)
{
    if (!document.contains("bufferViews")) {
        return;
    }
    for (size_t k = 0; k < document["bufferViews"].size(); ++k) {
        const json& view = document["bufferViews"][k];
        const std::string where = fmt::format("bufferViews[{}]", k);
        const auto buffer = view["buffer"].get<std::uint64_t>();
        const double end = double(whole_or(view, "byteOffset", 0)) +
                           double(view["byteLength"].get<std::uint64_t>());
        const auto length = document["buffers"][buffer]["byteLength"].get<std::uint64_t>();
        if (end > double(length)) {
            fail(where, fmt::format("ends at byte {} of buffer {}, which has {} bytes",
                                    std::uint64_t(end), buffer, length));
        }
        const auto stride = whole_or(view, "byteStride", 4);
        if (stride < 4 || stride > 252 || stride % 4 != 0) {
            fail(where + ".byteStride", "must be a multiple of 4 from 4 to 252");
        }
    }
}

void check_sparse(const json& document, const json& accessor, double size, const std::string& where)
{
    const json& sparse = accessor["sparse"];
    const auto count = sparse["count"].get<std::uint64_t>();
    if (count > accessor["count"].get<std::uint64_t>()) {
        fail(where + ".sparse.count", "is more than the accessor's own count");
    }
    const json& indices = sparse["indices"];
    const int type = indices["componentType"].get<int>();
    if (type != 5121 && type != 5123 && type != 5125) {
        fail(where + ".sparse.indices.componentType", "must be 5121, 5123 or 5125");
    }
    const double index_size = double(component_size(type));
    check_fit(document, indices["bufferView"].get<std::uint64_t>(),
              double(whole_or(indices, "byteOffset", 0)), double(count), index_size, index_size,
              where + ".sparse.indices");
    check_fit(document, sparse["values"]["bufferView"].get<std::uint64_t>(),
              double(whole_or(sparse["values"], "byteOffset", 0)), double(count), size, size,
              where + ".sparse.values");
}

void check_accessors(const json& document)
{
    if (!document.contains("accessors")) {
        return;
    }
    for (size_t k = 0; k < document["accessors"].size(); ++k) {
        const json& accessor = document["accessors"][k];
        const std::string where = fmt::format("accessors[{}]", k);
        const auto component_type = accessor["componentType"].get<std::uint64_t>();
        if (component_type > 6000 || component_size(int(component_type)) == 0) {
            fail(where + ".componentType", fmt::format("{} is not a type of glTF", component_type));
        }
        if (component_count(accessor["type"].get<std::string>()) == 0) {
            fail(where + ".type", "must be SCALAR, VEC2, VEC3, VEC4, MAT2, MAT3 or MAT4");
        }
        const double size =
            double(element_size(int(component_type), accessor["type"].get<std::string>()));
        if (accessor.contains("bufferView")) {
            const auto view = accessor["bufferView"].get<std::uint64_t>();
            const double stride =
                double(whole_or(document["bufferViews"][view], "byteStride", std::uint64_t(size)));
            if (stride < size) {
                fail(where, "its elements are longer than the byteStride");
            }
            check_fit(document, view, double(whole_or(accessor, "byteOffset", 0)),
                      double(accessor["count"].get<std::uint64_t>()), size, stride, where);
        }
        if (accessor.contains("sparse")) {
            check_sparse(document, accessor, size, where);
        }
    }
}

}  // namespace

size_t element_size(int component_type, const std::string& type)
{
    return component_size(component_type) * component_count(type);
}

json checked_gltf(const json& document)
{
    if (!document.is_object()) {
        fail("document", "must be an object");
    }
    json result = Checker(document).reduced(document, "glTF", "");
    check_buffer_views(result);
    check_accessors(result);
    return result;
}

}  // namespace diptych
