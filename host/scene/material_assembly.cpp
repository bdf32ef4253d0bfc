// Materials, the images they read, and the effects that all of it calls for.
#include "host/scene/scene_assembly.hpp"

#include "common/textures/procedural.h"

#include <algorithm>
#include <fmt/format.h>
#include <limits>

namespace diptych {
namespace {

bool is_lambert(const MaterialInput& m)
{
    return m.metallic == 0 &&
           (m.specular == 0 ||
            std::ranges::all_of(m.specular_color, [](float c) { return c == 0; }));
}

bool is_emissive(const MaterialInput& m)
{
    return !m.is_unlit && std::ranges::any_of(m.emission, [](float c) { return c > 0; });
}

// What a material really reads: a texture that cannot change the picture is not one of its slots.
MaterialInput effective(MaterialInput m)
{
    if (m.is_unlit) {
        m.normal_texture = {};
        m.metallic = m.specular = 0;
        m.emission = {0, 0, 0};
    }
    if (!is_emissive(m)) {
        m.emission_texture = {};
    }
    if (is_lambert(m)) {
        m.metallic_roughness_texture = m.specular_texture = m.specular_color_texture = {};
        m.specular = 0;
    }
    return m;
}

float texel_alpha(const Picture& p, size_t texel)
{
    return p.is_8_bit() ? float(p.bytes[4 * texel + 3]) / 255 : p.floats[4 * texel + 3];
}

float texel_srgb(const Picture& p, size_t texel, int channel)
{
    const size_t at = 4 * texel + size_t(channel);
    if (p.is_8_bit()) {
        return srgb_decode_byte(p.bytes[at]);
    }
    return p.is_integer ? srgb_decode(p.floats[at]) : p.floats[at];
}

}  // namespace

// Packs every picture for the ways in which it is used, once each, and lets go of it.
void SceneAssembly::assemble_images()
{
    std::vector<std::array<bool, 2>> uses_of(builder_.pictures_.size(), {false, false});
    const auto note = [&](const TextureUse& use, bool is_srgb) {
        if (use.image >= 0) {
            uses_of.at(size_t(use.image))[is_srgb] = true;
        }
    };
    for (size_t m = 0; m < builder_.materials_.size(); ++m) {
        if (!is_used(int(m))) {
            continue;
        }
        const MaterialInput material = effective(builder_.materials_[m]);
        note(material.base_texture, true);
        note(material.emission_texture, true);
        note(material.specular_color_texture, true);
        note(material.metallic_roughness_texture, false);
        note(material.normal_texture, false);
        note(material.specular_texture, false);
    }
    for (size_t k = 0; k < node_used_.size(); ++k) {
        if (!node_used_[k]) {
            continue;
        }
        for (const auto& [name, value] : builder_.texture_nodes_[k].arguments) {
            for (const TextureUse& use : value.images) {
                note(use, !value.is_linear);
            }
        }
    }
    pictures_.resize(uses_of.size());
    size_t bad_texels = 0;
    for (size_t k = 0; k < uses_of.size(); ++k) {
        Picture& picture = builder_.pictures_[k];
        PictureFacts& facts = pictures_[k];
        const size_t texels = size_t(picture.width) * size_t(picture.height);
        if (uses_of[k][0]) {
            facts.image_linear = pack_picture(picture, false, -1);
        }
        if (uses_of[k][1]) {
            facts.image_srgb = pack_picture(picture, true, facts.image_linear);
            for (size_t t = 0; t < texels; ++t) {
                facts.lowest_alpha = std::min(facts.lowest_alpha, texel_alpha(picture, t));
                for (int c = 0; c < 3; ++c) {
                    facts.mean_srgb[c] += texel_srgb(picture, t, c);
                }
            }
            for (double& c : facts.mean_srgb) {
                c /= double(texels);
            }
        }
        if (uses_of[k][0] || uses_of[k][1]) {
            bad_texels += picture.bad_texels;
        }
        picture = Picture{};
    }
    if (data_.images.empty()) {  // kernels read a texel first, and then choose
        data_.images.push_back({1, 1, 0, TEXELS_8_LINEAR});
        data_.texels_8.push_back(0xffffffffu);
        data_.texture_slots.push_back({});
    }
    if (bad_texels > 0) {
        data_.notices.push_back(fmt::format("textures: {} values were NaN, infinite or negative; "
                                            "they were replaced",
                                            bad_texels));
    }
}

// Returns the index of a new Image. `shared` names one with the same 8-bit texels, or is -1.
int SceneAssembly::pack_picture(const Picture& picture, bool is_srgb, int shared)
{
    const size_t texels = size_t(picture.width) * size_t(picture.height);
    const size_t first = picture.is_8_bit() ? data_.texels_8.size() : data_.texels_float.size();
    if (first + texels > size_t(std::numeric_limits<int>::max())) {
        throw SceneError("the scene: its images hold more texels than 32-bit indices reach; use "
                         "smaller images");
    }
    Image image{picture.width, picture.height, int(first), TEXELS_FLOAT};
    if (picture.is_8_bit()) {
        image.encoding = is_srgb ? TEXELS_8_SRGB : TEXELS_8_LINEAR;
        if (shared >= 0) {
            image.first_texel = data_.images[size_t(shared)].first_texel;
        } else {
            data_.texels_8.reserve(first + texels);
            for (size_t t = 0; t < texels; ++t) {
                const std::uint8_t* b = &picture.bytes[4 * t];
                data_.texels_8.push_back(uint(b[0]) | uint(b[1]) << 8 | uint(b[2]) << 16 |
                                         uint(b[3]) << 24);
            }
        }
    } else {
        const bool decode = is_srgb && picture.is_integer;
        data_.texels_float.reserve(first + texels);
        for (size_t t = 0; t < texels; ++t) {
            const float* f = &picture.floats[4 * t];
            data_.texels_float.push_back(
                decode ? float4{srgb_decode(f[0]), srgb_decode(f[1]), srgb_decode(f[2]), f[3]}
                       : float4{f[0], f[1], f[2], f[3]});
        }
    }
    data_.images.push_back(image);
    return int(data_.images.size()) - 1;
}

int SceneAssembly::add_slot(const TextureUse& use, bool is_srgb)
{
    if (use.node >= 0) {
        return TEXTURE_PROCEDURAL;
    }
    if (use.image < 0) {
        return -1;
    }
    if (use.uv_set < 0 || use.uv_set >= int(uv_slots_.size())) {
        throw SceneError(fmt::format("the scene: a material reads UV set {}; sets 0 to {} can be "
                                     "used",
                                     use.uv_set, uv_slots_.size() - 1));
    }
    int& stored_set = uv_slots_[size_t(use.uv_set)];
    if (stored_set < 0) {
        stored_set = uv_set_count_++;
    }
    return add_image_slot(use, is_srgb, stored_set);
}

int SceneAssembly::add_image_slot(const TextureUse& use, bool is_srgb, int stored_set)
{
    const PictureFacts& facts = pictures_[size_t(use.image)];
    TextureSlot slot{};
    slot.image = is_srgb ? facts.image_srgb : facts.image_linear;
    slot.uv_set = stored_set;
    slot.wrap = use.wrap_u + 4 * use.wrap_v;
    slot.filter = use.filter;
    const auto& m = use.to_uv;
    slot.to_u = {float(m[0][0]), float(m[0][1]), float(m[0][2]), 0};
    slot.to_v = {float(m[1][0]), float(m[1][1]), float(m[1][2]), 0};
    data_.texture_slots.push_back(slot);
    return int(data_.texture_slots.size()) - 1;
}

// Whether alpha can do anything at all: a mask that no texel fails is opaque.
bool SceneAssembly::can_be_transparent(const MaterialInput& m) const
{
    if (m.alpha_mode == ALPHA_OPAQUE) {
        return false;
    }
    if (m.base_texture.node >= 0) return true;
    const size_t index = size_t(&m - builder_.materials_.data());
    if (material_colored_[index]) {
        return true;
    }
    float lowest = m.base_color[3];
    if (m.base_texture.image >= 0) {
        lowest *= pictures_[size_t(m.base_texture.image)].lowest_alpha;
    }
    return lowest < (m.alpha_mode == ALPHA_MASK ? m.alpha_cutoff : 1.0f);
}

Material SceneAssembly::packed_material(const MaterialInput& input)
{
    const MaterialInput m = effective(input);
    Material packed{};
    packed.base_color = {m.base_color[0], m.base_color[1], m.base_color[2], m.base_color[3]};
    packed.emission = {m.emission[0], m.emission[1], m.emission[2], 0};
    packed.specular_color = {m.specular_color[0], m.specular_color[1], m.specular_color[2],
                             m.specular};
    packed.metallic = m.metallic;
    packed.roughness = m.roughness;
    // KHR_materials_ior: 0 stands for an infinite index, a Fresnel reflectance of 1.
    const double f = m.ior == 0 ? 1 : (double(m.ior) - 1) / (double(m.ior) + 1);
    packed.dielectric_f0 = float(f * f);
    packed.alpha_cutoff = m.alpha_cutoff;
    packed.normal_scale = m.normal_scale;
    packed.alpha_mode = can_be_transparent(input) ? m.alpha_mode : ALPHA_OPAQUE;
    packed.flags =
        (m.is_unlit ? MATERIAL_UNLIT : 0) | (m.is_double_sided ? MATERIAL_DOUBLE_SIDED : 0);
    packed.base_slot = add_slot(m.base_texture, true);
    packed.metallic_roughness_slot = add_slot(m.metallic_roughness_texture, false);
    packed.normal_slot = add_slot(m.normal_texture, false);
    packed.emission_slot = add_slot(m.emission_texture, true);
    packed.specular_slot = add_slot(m.specular_texture, false);
    packed.specular_color_slot = add_slot(m.specular_color_texture, true);
    return packed;
}

void SceneAssembly::assemble_materials()
{
    uv_slots_.fill(-1);
    const unsigned first_uv = ATTRIBUTE_TexCoord0 | ATTRIBUTE_TexCoord0Dx | ATTRIBUTE_TexCoord0Dy;
    if ((attributes_ & first_uv) != 0) {
        uv_slots_[0] = uv_set_count_++;
    }
    if ((attributes_ & ATTRIBUTE_TexCoord1) != 0) {
        uv_slots_[1] = uv_set_count_++;
    }
    for (size_t k = 0; k < builder_.materials_.size(); ++k) {
        const MaterialInput& input = builder_.materials_[k];
        const TextureUse none;
        MaterialInput bare = input;
        for (TextureUse* use :
             {&bare.base_texture, &bare.metallic_roughness_texture, &bare.normal_texture,
              &bare.emission_texture, &bare.specular_texture, &bare.specular_color_texture}) {
            *use = none;
        }
        data_.material_names.push_back(input.name.empty() ? fmt::format("material {}", k)
                                                          : input.name);
        std::array<double, 3> mean{};
        if (is_used(int(k))) {
            data_.materials.push_back(packed_material(input));
            const int image =
                data_.materials.back().emission_slot < 0 ? -1 : input.emission_texture.image;
            const float4 e = data_.materials.back().emission;
            mean = {e.x, e.y, e.z};
            for (size_t c = 0; c < 3 && image >= 0; ++c) {
                mean[c] *= pictures_[size_t(image)].mean_srgb[c];
            }
        } else {
            bare.alpha_mode = ALPHA_OPAQUE;
            data_.materials.push_back(packed_material(bare));
        }
        mean_emission_.push_back(mean);
    }
    data_.settings[0].uv_set_count = uv_set_count_;
}

void SceneAssembly::assemble_effects()
{
    unsigned mask = 0;
    const auto set_if = [&](bool condition, unsigned effect) { mask |= condition ? effect : 0; };
    for (size_t k = 0; k < data_.materials.size(); ++k) {
        if (!is_used(int(k))) {
            continue;
        }
        const Material& m = data_.materials[k];
        set_if(m.metallic > 0 || m.specular_color.w > 0, EFFECT_SPECULAR);
        set_if(m.base_slot >= 0, EFFECT_BASE_TEXTURE);
        set_if(m.metallic_roughness_slot >= 0 || m.specular_slot >= 0 || m.specular_color_slot >= 0,
               EFFECT_SURFACE_TEXTURES);
        set_if(m.normal_slot != -1, EFFECT_NORMAL_MAP);
        set_if(m.emission.x > 0 || m.emission.y > 0 || m.emission.z > 0, EFFECT_EMISSION);
        set_if(m.emission_slot >= 0, EFFECT_EMISSION_TEXTURE);
        set_if(m.alpha_mode != ALPHA_OPAQUE, EFFECT_ALPHA);
        set_if((m.flags & MATERIAL_UNLIT) != 0, EFFECT_UNLIT);
    }
    for (const Image& image : data_.images) {
        set_if(image.encoding == TEXELS_FLOAT, EFFECT_FLOAT_TEXTURES);
    }
    const Settings& settings = data_.settings[0];
    set_if(settings.environment_width > 0, EFFECT_ENVIRONMENT);
    set_if(data_.instances.size() > 1, EFFECT_INSTANCES);
    set_if(any_normals_, EFFECT_SMOOTH_NORMALS);
    set_if(any_colors_, EFFECT_VERTEX_COLOR);
    set_if(settings.camera_kind == CAMERA_ORTHOGRAPHIC, EFFECT_ORTHOGRAPHIC);
    data_.effects = mask & ~builder_.disabled_effects_;
}

}  // namespace diptych
