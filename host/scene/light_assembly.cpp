// Everything that light sampling can choose, each with its probability: proportional to its power.
#include "host/scene/alias_table.hpp"
#include "host/scene/scene_assembly.hpp"

#include <fmt/format.h>
#include <limits>
#include <numbers>

namespace diptych {
namespace {

using std::numbers::pi;

Vec3 corner(const float4& p) { return {p.x, p.y, p.z}; }
float4 to_float4(const Vec3& v) { return {float(v[0]), float(v[1]), float(v[2]), 0}; }

Transform to_world(const Instance& instance)
{
    Transform t;
    const float4 rows[3] = {instance.to_world_x, instance.to_world_y, instance.to_world_z};
    for (size_t i = 0; i < 3; ++i) {
        t.row[i] = {rows[i].x, rows[i].y, rows[i].z, rows[i].w};
    }
    return t;
}

// W (or the luminance of it): radiant intensity over the solid angle that it reaches, or irradiance
// over the scene's cross section.
double power_of(const PunctualLight& light, double scene_radius)
{
    const double i = luminance(light.intensity[0], light.intensity[1], light.intensity[2]);
    switch (light.kind) {
    case LIGHT_POINT:
        return 4 * pi * i;
    case LIGHT_SPOT:
        return 2 * pi * (1 - std::cos(light.outer_angle)) * i;
    default:
        return pi * scene_radius * scene_radius * i;
    }
}

Light packed_light(const PunctualLight& light)
{
    Light packed{};
    packed.kind = light.kind;
    packed.position = to_float4(light.position);
    packed.edge1 = to_float4(unit(light.direction));
    packed.emission = {light.intensity[0], light.intensity[1], light.intensity[2], 0};
    packed.triangle = packed.instance = 0;  // vector code reads them before it knows the kind
    packed.range = float(light.range);
    if (light.kind == LIGHT_SPOT) {
        // At least 0.001 between the cosines, as the extension's reference code has it.
        const double outer = std::cos(light.outer_angle), inner = std::cos(light.inner_angle);
        packed.edge2 = {float(outer), float(1 / std::max(0.001, inner - outer)), 0, 0};
    }
    return packed;
}

// Radiance that white surfaces about the scene would have, of the light that nothing blocks: less
// is black in a picture, a step or two of 255.
constexpr double dark = 0.001;

}  // namespace

void SceneAssembly::add_triangle_lights(std::vector<double>& powers)
{
    for (size_t n = 0; n < data_.instances.size(); ++n) {
        const Instance& instance = data_.instances[n];
        const Transform placed = to_world(instance);
        for (int k = 0; k < instance.triangle_count; ++k) {
            const int triangle_id = instance.first_triangle + k;
            const Triangle& t = data_.triangles[size_t(triangle_id)];
            const auto& mean = mean_emission_[size_t(t.material)];
            const double brightness = luminance(mean[0], mean[1], mean[2]);
            if (!(brightness > 0)) {
                continue;
            }
            const Vec3 a = placed.point(corner(data_.positions[size_t(t.vertex0)]));
            const Vec3 e1 = placed.point(corner(data_.positions[size_t(t.vertex1)])) - a;
            const Vec3 e2 = placed.point(corner(data_.positions[size_t(t.vertex2)])) - a;
            Light light{};
            light.kind = LIGHT_TRIANGLE;
            light.position = to_float4(a);
            light.edge1 = to_float4(e1);
            light.edge2 = to_float4(e2);
            light.emission = {float(mean[0]), float(mean[1]), float(mean[2]), 0};
            const Material& material = data_.materials[size_t(t.material)];
            if (material.emission_slot == TEXTURE_PROCEDURAL) light.emission = material.emission;
            light.triangle = triangle_id;
            light.instance = int(n);
            light.normal_sign = instance.is_mirrored ? -1.0f : 1.0f;
            data_.lights.push_back(light);
            powers.push_back(pi * 0.5 * length(cross(e1, e2)) * brightness);
        }
    }
}

void SceneAssembly::add_punctual_lights(std::vector<double>& powers)
{
    for (const PunctualLight& light : builder_.lights_) {
        const double power = power_of(light, data_.settings[0].scene_radius);
        if (!(power > 0)) {
            continue;
        }
        data_.lights.push_back(packed_light(light));
        powers.push_back(power);
        data_.effects |= EFFECT_PUNCTUAL_LIGHTS & ~builder_.disabled_effects_;
    }
}

void SceneAssembly::assemble_lights()
{
    Settings& settings = data_.settings[0];
    const double radius = settings.scene_radius;
    std::vector<double> powers;
    add_triangle_lights(powers);
    add_punctual_lights(powers);
    if (environment_power_ > 0) {
        Light light{};
        light.kind = LIGHT_ENVIRONMENT;
        light.triangle = light.instance = 0;
        settings.environment_light = int(data_.lights.size());
        data_.lights.push_back(light);
        powers.push_back(pi * radius * radius * environment_power_);
    }
    if (data_.lights.size() > size_t(std::numeric_limits<int>::max())) {
        throw SceneError("the scene: more emissive triangles than 32-bit indices reach; make fewer "
                         "things emissive");
    }
    data_.light_choice = alias_table(powers);
    double total = 0;
    for (const double power : powers) {
        total += power;
    }
    if (!(total > 0) || !std::isfinite(total)) {
        if (total > 0) {
            throw SceneError("the scene: its lights' power is not finite; dim them");
        }
        data_.lights.clear();
    }
    if (total > 0 && total < dark * 4 * pi * pi * radius * radius) {
        data_.notices.push_back(fmt::format(
            "lights: all that the scene has give {:.2g} W, and leave it nearly black; light it "
            "with --env FILE, or raise --exposure",
            total));
    }
    for (size_t k = 0; k < data_.lights.size(); ++k) {
        data_.lights[k].emission.w = float(powers[k] / total);
    }
    settings.light_count = int(data_.lights.size());
    if (settings.environment_light >= 0) {
        settings.environment_probability = data_.lights.back().emission.w;
    }
    for (size_t m = 0; m < mean_emission_.size(); ++m) {
        const auto& mean = mean_emission_[m];
        const double density = pi * luminance(mean[0], mean[1], mean[2]) / total;
        data_.materials[m].emission.w = total > 0 ? float(density) : 0.0f;
    }
}

}  // namespace diptych
