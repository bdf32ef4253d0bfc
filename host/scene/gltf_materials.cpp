// Materials and the images they read.
#include "host/scene/gltf_loader.hpp"

#include "kernels_cpu/parallel_for.hpp"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <limits>

namespace diptych {
namespace {

float in_unit_range(double value) { return float(std::clamp(value, 0.0, 1.0)); }
float not_negative(double value)
{
    return float(std::clamp(value, 0.0, double(std::numeric_limits<float>::max())));
}

int wrap_mode(int gl_constant)
{
    switch (gl_constant) {
    case TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE:
        return WRAP_CLAMP;
    case TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT:
        return WRAP_MIRROR;
    default:
        return WRAP_REPEAT;
    }
}

std::array<double, 2> pair_of(const tinygltf::Value& object, const char* key, double fallback)
{
    if (!object.Has(key)) {
        return {fallback, fallback};
    }
    return {object.Get(key).Get(0).GetNumberAsDouble(), object.Get(key).Get(1).GetNumberAsDouble()};
}

// KHR_texture_transform: scale, then rotate, then shift.
std::array<std::array<double, 3>, 2> uv_transform(const tinygltf::Value& transform)
{
    const auto offset = pair_of(transform, "offset", 0), scale = pair_of(transform, "scale", 1);
    const double angle = number_of(transform, "rotation", 0);
    const double c = std::cos(angle), s = std::sin(angle);
    return {{{c * scale[0], s * scale[1], offset[0]}, {-s * scale[0], c * scale[1], offset[1]}}};
}

}  // namespace

TextureUse GltfLoader::texture_use(int texture, int uv_set,
                                   const tinygltf::ExtensionMap& extensions) const
{
    TextureUse use;
    use.image = texture;  // its image is found once it is known that something uses it
    use.uv_set = uv_set;
    if (texture < 0) {
        return use;
    }
    const int sampler = model_.textures[size_t(texture)].sampler;
    if (sampler >= 0) {
        const tinygltf::Sampler& source = model_.samplers[size_t(sampler)];
        use.wrap_u = wrap_mode(source.wrapS);
        use.wrap_v = wrap_mode(source.wrapT);
        use.filter =
            source.magFilter == TINYGLTF_TEXTURE_FILTER_NEAREST ? TEXTURE_NEAREST : TEXTURE_LINEAR;
    }
    if (const auto at = extensions.find("KHR_texture_transform"); at != extensions.end()) {
        use.to_uv = uv_transform(at->second);
        use.uv_set = int(number_of(at->second, "texCoord", uv_set));
    }
    return use;
}

MaterialInput GltfLoader::material_input(int index) const
{
    const tinygltf::Material& source = model_.materials[size_t(index)];
    const auto& pbr = source.pbrMetallicRoughness;
    MaterialInput m;
    m.name = source.name.empty() ? fmt::format("material {}", index) : source.name;
    for (size_t c = 0; c < 4 && pbr.baseColorFactor.size() == 4; ++c) {
        m.base_color[c] = in_unit_range(pbr.baseColorFactor[c]);
    }
    m.metallic = in_unit_range(pbr.metallicFactor);
    m.roughness = in_unit_range(pbr.roughnessFactor);
    m.normal_scale = float(source.normalTexture.scale);
    m.alpha_mode = source.alphaMode == "MASK"    ? ALPHA_MASK
                   : source.alphaMode == "BLEND" ? ALPHA_BLEND
                                                 : ALPHA_OPAQUE;
    m.alpha_cutoff = not_negative(source.alphaCutoff);
    m.is_double_sided = source.doubleSided;
    const auto use = [&](const auto& info) {
        return texture_use(info.index, info.texCoord, info.extensions);
    };
    m.base_texture = use(pbr.baseColorTexture);
    m.metallic_roughness_texture = use(pbr.metallicRoughnessTexture);
    m.normal_texture = use(source.normalTexture);
    m.emission_texture = use(source.emissiveTexture);

    double strength = 1;
    const auto& extensions = source.extensions;
    m.is_unlit = extensions.count("KHR_materials_unlit") > 0;
    if (const auto at = extensions.find("KHR_materials_emissive_strength");
        at != extensions.end()) {
        strength = number_of(at->second, "emissiveStrength", 1);
    }
    if (const auto at = extensions.find("KHR_materials_ior"); at != extensions.end()) {
        const double ior = number_of(at->second, "ior", 1.5);
        m.ior = ior == 0 ? 0.0f : std::max(1.0f, not_negative(ior));
    }
    if (const auto at = extensions.find("KHR_materials_specular"); at != extensions.end()) {
        const tinygltf::Value& specular = at->second;
        m.specular = in_unit_range(number_of(specular, "specularFactor", 1));
        if (specular.Has("specularColorFactor")) {
            for (int c = 0; c < 3; ++c) {
                m.specular_color[size_t(c)] =
                    not_negative(specular.Get("specularColorFactor").Get(c).GetNumberAsDouble());
            }
        }
        const auto value_use = [&](const char* key) {
            if (!specular.Has(key)) {
                return TextureUse{};
            }
            const tinygltf::Value& info = specular.Get(key);
            tinygltf::ExtensionMap own;
            if (info.Has("extensions") && info.Get("extensions").Has("KHR_texture_transform")) {
                own["KHR_texture_transform"] = info.Get("extensions").Get("KHR_texture_transform");
            }
            return texture_use(info.Get("index").GetNumberAsInt(),
                               int(number_of(info, "texCoord", 0)), own);
        };
        m.specular_texture = value_use("specularTexture");
        m.specular_color_texture = value_use("specularColorTexture");
    }
    for (size_t c = 0; c < 3 && source.emissiveFactor.size() == 3; ++c) {
        m.emission[c] = not_negative(in_unit_range(source.emissiveFactor[c]) * strength);
    }
    return m;
}

void GltfLoader::add_materials()
{
    for (int k = 0; k < int(model_.materials.size()); ++k) {
        materials_.push_back(material_input(k));
    }
}

// The image of a texture: its own, or that of an extension whose format we read.
int GltfLoader::image_of(int texture) const
{
    const tinygltf::Texture& source = model_.textures[size_t(texture)];
    const auto at = source.extensions.find("EXT_texture_webp");
    if (source.source < 0 && at != source.extensions.end() && at->second.Has("source")) {
        return at->second.Get("source").GetNumberAsInt();
    }
    return source.source;
}

// The same for a texture that `user` cannot do without.
int GltfLoader::used_image(int texture, const std::string& user) const
{
    const int image = image_of(texture);
    if (image >= 0) {
        return image;
    }
    const bool is_basis =
        model_.textures[size_t(texture)].extensions.count("KHR_texture_basisu") > 0;
    throw SceneError(
        fmt::format("textures[{}]{}: {}; export it with PNG or JPEG images", texture, user,
                    is_basis ? "has only a KTX2 image (KHR_texture_basisu), which cannot be read"
                             : "has no image"));
}

// Images take most of a textured scene's loading: on all threads. Of several broken ones the first
// is named.
void GltfLoader::decode(const std::vector<StoredImage>& images)
{
    std::vector<Picture> pictures(images.size());
    std::vector<std::exception_ptr> errors(images.size());
    parallel_for(0, int(images.size()), [&](int index) {
        const size_t k = size_t(index);
        try {
            pictures[k] = read_picture(images[k].bytes, images[k].where, options_.max_image_pixels);
        } catch (...) {
            errors[k] = std::current_exception();
        }
    });
    for (size_t k = 0; k < images.size(); ++k) {
        if (errors[k]) {
            std::rethrow_exception(errors[k]);
        }
        scene_.add_image(std::move(pictures[k]));
    }
}

// Reads every image that a material in use reads, once, and renumbers the materials' textures.
void GltfLoader::read_images()
{
    std::vector<char> is_used(materials_.size(), 0);
    for (const NodePlacement& placement : placements_) {
        for (const auto& primitive : model_.meshes[size_t(placement.mesh)].primitives) {
            if (primitive.material >= 0) {
                is_used[size_t(primitive.material)] = 1;
            }
        }
    }
    std::map<int, int> numbers;  // of images of the file, in the builder
    std::vector<StoredImage> images;
    const auto resolve = [&](TextureUse& use, const std::string& user) {
        if (use.image < 0) {
            return;
        }
        const int image = used_image(use.image, user);
        const auto [at, is_new] = numbers.try_emplace(image, int(images.size()));
        if (is_new) {
            images.push_back(document_.stored_image(image, user));
        }
        use.image = at->second;
    };
    for (TextureNode& node : texture_nodes_) {
        for (auto& [name, value] : node.arguments) {
            for (TextureUse& use : value.images) {
                resolve(use, fmt::format(", of texture node \"{}\"", node.name));
            }
        }
    }
    for (size_t k = 0; k < materials_.size(); ++k) {
        MaterialInput& m = materials_[k];
        for (TextureUse* use :
             {&m.base_texture, &m.metallic_roughness_texture, &m.normal_texture,
              &m.emission_texture, &m.specular_texture, &m.specular_color_texture}) {
            if (!is_used[k]) {
                use->image = -1;
            }
            resolve(*use, fmt::format(", of material \"{}\"", m.name));
        }
    }
    decode(images);
}

}  // namespace diptych
