// glTF's metallic-roughness surface: a GGX lobe over a diffuse one.
//
// Specular: GGX with height-correlated Smith masking, Schlick's Fresnel, and the light that bounces
// between microfacets given back as a lobe of its own (Kulla and Conty, "Revisiting Physically
// Based Shading at Imageworks", 2017), so that a white metal reflects all light at every roughness.
// Diffuse: what the dielectric interface lets in and out, in the same form, so that a white
// dielectric does too. Both are reciprocal. Local frame: z is the shading normal, wo looks to where
// the path came from, wi to where it goes.
#pragma once

#include "platform.h"

#include "common/materials/ggx_albedo_table.h"
#include "common/math.h"

// Below this alpha a lobe is a mirror: its angular width (3e-4 rad) is under what float directions
// can carry.
#define MIRROR_ALPHA 1e-4f

typedef struct {
    float3 base_color;
    float metallic;
    float roughness;
    float3 dielectric_f0;
    float dielectric_f90;
} Surface;

// A surface seen from one direction.
typedef struct {
    float3 diffuse;  // diffuse reflectance where the interface is transparent
    float3 f0;
    float f90;
    float3 bounced;  // albedo of the light between microfacets, per share that takes part in it
    float alpha;
    float roughness;
    int is_mirror;
    float all_average;    // 1 - average directional albedo at F = 1
    float dielectric_f0;  // largest channel
    float dielectric_f90;
    float dielectric_bounced;
    float dielectric_through;  // 1 - dielectric albedo, seen from wo
    float dielectric_average;  // average of the same over directions
    float not_single;          // 1 - directional albedo at F = 1, seen from wo
    float specular_probability;
} Lobes;

typedef struct {
    float3 value;  // BRDF times cosine
    float pdf;     // density over solid angle
} Scatter;

// The albedo of single scattering at F = 1 (x) and its share weighed by Schlick's (1 - v.h)^5 (y).
SHARED float2 ggx_albedo(float cosine, float roughness)
{
    const float across = math_sqrt(math_clamp(cosine, 0.0f, 1.0f)) * (float)(GGX_ALBEDO_SIZE - 1);
    const float along = math_sqrt(math_clamp(roughness, 0.0f, 1.0f)) * (float)(GGX_ALBEDO_SIZE - 1);
    const int column = across >= (float)(GGX_ALBEDO_SIZE - 2) ? GGX_ALBEDO_SIZE - 2 : (int)across;
    const int row = along >= (float)(GGX_ALBEDO_SIZE - 2) ? GGX_ALBEDO_SIZE - 2 : (int)along;
    const float x = across - (float)column;
    const float y = along - (float)row;
    const int k = row * GGX_ALBEDO_SIZE + column;
    const float w00 = (1.0f - x) * (1.0f - y);
    const float w10 = x * (1.0f - y);
    const float w01 = (1.0f - x) * y;
    const float w11 = x * y;
    return make_float2(ggx_albedo_all[k] * w00 + ggx_albedo_all[k + 1] * w10 +
                           ggx_albedo_all[k + GGX_ALBEDO_SIZE] * w01 +
                           ggx_albedo_all[k + GGX_ALBEDO_SIZE + 1] * w11,
                       ggx_albedo_schlick[k] * w00 + ggx_albedo_schlick[k + 1] * w10 +
                           ggx_albedo_schlick[k + GGX_ALBEDO_SIZE] * w01 +
                           ggx_albedo_schlick[k + GGX_ALBEDO_SIZE + 1] * w11);
}

// The same averaged over the hemisphere, cosine-weighted.
SHARED float2 ggx_average(float roughness)
{
    const float along = math_sqrt(math_clamp(roughness, 0.0f, 1.0f)) * (float)(GGX_ALBEDO_SIZE - 1);
    const int row = along >= (float)(GGX_ALBEDO_SIZE - 2) ? GGX_ALBEDO_SIZE - 2 : (int)along;
    const float y = along - (float)row;
    return make_float2(ggx_average_all[row] * (1.0f - y) + ggx_average_all[row + 1] * y,
                       ggx_average_schlick[row] * (1.0f - y) + ggx_average_schlick[row + 1] * y);
}

// Albedo of light that bounced between microfacets of Fresnel reflectance f0 .. f90 (Kulla and
// Conty, slide 16).
SHARED float bounced_albedo(float f0, float f90, float all_average)
{
    const float f = f0 + (f90 - f0) * (1.0f / 21.0f);
    return f * f * all_average / (1.0f - f * (1.0f - all_average));
}

SHARED float interface_albedo(float f0, float f90, float bounced, float2 albedo)
{
    return f0 * (albedo.x - albedo.y) + f90 * albedo.y + bounced * (1.0f - albedo.x);
}

SHARED Lobes lobes_of(Surface surface, float cosine)
{
    Lobes lobes;
    const float keep = 1.0f - surface.metallic;
    lobes.diffuse = surface.base_color * keep;
    lobes.f0 = surface.dielectric_f0 * keep + surface.base_color * surface.metallic;
    lobes.f90 = surface.dielectric_f90 * keep + surface.metallic;
    lobes.alpha = surface.roughness * surface.roughness;
    lobes.is_mirror = lobes.alpha < MIRROR_ALPHA;
    lobes.roughness = lobes.is_mirror ? 0.0f : surface.roughness;

    const float2 table_albedo = ggx_albedo(cosine, lobes.roughness);
    const float2 table_average = ggx_average(lobes.roughness);
    const float grazing = 1.0f - cosine;
    const float grazing2 = grazing * grazing;
    const float2 albedo =
        make_float2(lobes.is_mirror ? 1.0f : table_albedo.x,
                    lobes.is_mirror ? grazing2 * grazing2 * grazing : table_albedo.y);
    const float2 average = make_float2(lobes.is_mirror ? 1.0f : table_average.x,
                                       lobes.is_mirror ? 1.0f / 21.0f : table_average.y);
    lobes.all_average = 1.0f - average.x;
    lobes.not_single = 1.0f - albedo.x;
    lobes.bounced = make_float3(bounced_albedo(lobes.f0.x, lobes.f90, average.x),
                                bounced_albedo(lobes.f0.y, lobes.f90, average.x),
                                bounced_albedo(lobes.f0.z, lobes.f90, average.x));

    lobes.dielectric_f0 = vec_max_component(surface.dielectric_f0);
    lobes.dielectric_f90 = surface.dielectric_f90;
    lobes.dielectric_bounced = bounced_albedo(lobes.dielectric_f0, lobes.dielectric_f90, average.x);
    lobes.dielectric_through = 1.0f - interface_albedo(lobes.dielectric_f0, lobes.dielectric_f90,
                                                       lobes.dielectric_bounced, albedo);
    lobes.dielectric_average = 1.0f - interface_albedo(lobes.dielectric_f0, lobes.dielectric_f90,
                                                       lobes.dielectric_bounced, average);

    const float single = vec_luminance(lobes.f0) * (albedo.x - albedo.y) + lobes.f90 * albedo.y;
    const float spread = vec_luminance(lobes.diffuse) * lobes.dielectric_through +
                         vec_luminance(lobes.bounced) * lobes.not_single;
    const float total = single + spread;
    lobes.specular_probability = single / math_greater(total, 1e-20f);
    return lobes;
}

// The lobes that scatter widely: diffuse, and light that bounced between microfacets. BRDF, not
// times cosine.
SHARED float3 lobes_spread(Lobes lobes, float cosine_in)
{
    const float2 table_albedo = ggx_albedo(cosine_in, lobes.roughness);
    const float grazing = 1.0f - cosine_in;
    const float grazing2 = grazing * grazing;
    const float2 albedo =
        make_float2(lobes.is_mirror ? 1.0f : table_albedo.x,
                    lobes.is_mirror ? grazing2 * grazing2 * grazing : table_albedo.y);
    const float through = 1.0f - interface_albedo(lobes.dielectric_f0, lobes.dielectric_f90,
                                                  lobes.dielectric_bounced, albedo);
    const float diffuse = lobes.dielectric_average > 0.0f ? INV_PI * lobes.dielectric_through *
                                                                through / lobes.dielectric_average
                                                          : 0.0f;
    const float bounced = lobes.all_average > 0.0f
                              ? INV_PI * lobes.not_single * (1.0f - albedo.x) / lobes.all_average
                              : 0.0f;
    return lobes.diffuse * diffuse + lobes.bounced * bounced;
}

// sin^2 of the halfway vector's angle is computed from its components, not from 1 - cos^2, which
// loses every digit of a narrow lobe.
SHARED float ggx_distribution(float3 halfway, float alpha)
{
    const float alpha2 = alpha * alpha;
    const float d = halfway.x * halfway.x + halfway.y * halfway.y + alpha2 * halfway.z * halfway.z;
    return alpha2 * INV_PI / (d * d);
}

// cos * sqrt(1 + alpha^2 tan^2): Smith's masking, multiplied out.
SHARED float smith_term(float cosine, float alpha2)
{
    return math_sqrt(alpha2 + (1.0f - alpha2) * cosine * cosine);
}

SHARED float3 fresnel_schlick(float3 f0, float f90, float cosine)
{
    const float grazing = 1.0f - math_clamp(cosine, 0.0f, 1.0f);
    const float g2 = grazing * grazing;
    const float weight = g2 * g2 * grazing;
    return f0 * (1.0f - weight) + make_float3(f90, f90, f90) * weight;
}

// BRDF times cosine, and the density with which lobes_sample finds wi. A mirror's own lobe counts
// in neither.
SHARED Scatter lobes_evaluate(Lobes lobes, float3 wo, float3 wi)
{
    const int is_above = (wo.z > 0.0f) & (wi.z > 0.0f);
    const float cosine_out = math_greater(wo.z, 1e-6f);
    const float cosine_in = math_greater(wi.z, 1e-6f);
    const float alpha = math_greater(lobes.alpha, MIRROR_ALPHA);
    const float alpha2 = alpha * alpha;
    const float3 halfway = vec_normalize(wo + wi);
    const float distribution = ggx_distribution(halfway, alpha);
    const float smith_out = smith_term(cosine_out, alpha2);
    const float smith_in = smith_term(cosine_in, alpha2);
    const float masked =
        distribution * 0.5f / (cosine_in * smith_out + cosine_out * smith_in) * cosine_in;
    const float visible_pdf = distribution * 0.5f / (cosine_out + smith_out);

    const float single = lobes.is_mirror ? 0.0f : masked;
    const float single_pdf = lobes.is_mirror ? 0.0f : visible_pdf;
    const float3 value = fresnel_schlick(lobes.f0, lobes.f90, vec_dot(wo, halfway)) * single +
                         lobes_spread(lobes, cosine_in) * cosine_in;
    const float pdf = lobes.specular_probability * single_pdf +
                      (1.0f - lobes.specular_probability) * cosine_in * INV_PI;
    Scatter scatter;
    scatter.value = make_float3(is_above ? value.x : 0.0f, is_above ? value.y : 0.0f,
                                is_above ? value.z : 0.0f);
    scatter.pdf = is_above ? pdf : 0.0f;
    return scatter;
}

// The microfacet normal seen from wo: Dupuy and Benyoub, "Sampling Visible GGX Normals with
// Spherical Caps", 2023.
SHARED float3 ggx_sample_visible(float3 wo, float alpha, float cap, float cos_phi, float sin_phi)
{
    const float3 stretched = vec_normalize(make_float3(wo.x * alpha, wo.y * alpha, wo.z));
    const float z = (1.0f - cap) * (1.0f + stretched.z) - stretched.z;
    const float radius = math_sqrt(math_clamp(1.0f - z * z, 0.0f, 1.0f));
    const float3 sum = make_float3(radius * cos_phi + stretched.x, radius * sin_phi + stretched.y,
                                   z + stretched.z);
    return vec_normalize(make_float3(sum.x * alpha, sum.y * alpha, math_greater(sum.z, 1e-12f)));
}

typedef struct {
    float3 wi;
    float3 weight;  // BRDF times cosine over density
    float pdf;      // 0 for a mirror direction
} ScatterSample;

// u in [0, 1)^2.
SHARED ScatterSample lobes_sample(Lobes lobes, float3 wo, float2 u)
{
    const float p = lobes.specular_probability;
    const int is_specular = u.x < p;
    const float radial = is_specular
                             ? u.x / math_greater(p, 1e-12f)
                             : math_lesser((u.x - p) / math_greater(1.0f - p, 1e-12f), 1.0f);
    const float turn = 2.0f * u.y;
    const float cos_phi = math_cospi(turn);
    const float sin_phi = math_sinpi(turn);

    const float alpha = math_greater(lobes.alpha, MIRROR_ALPHA);
    const float3 visible = ggx_sample_visible(wo, alpha, radial, cos_phi, sin_phi);
    const float3 halfway =
        make_float3(lobes.is_mirror ? 0.0f : visible.x, lobes.is_mirror ? 0.0f : visible.y,
                    lobes.is_mirror ? 1.0f : visible.z);
    const float3 reflected = halfway * (2.0f * vec_dot(wo, halfway)) - wo;
    const float disc = math_sqrt(radial);
    const float3 cosine = make_float3(disc * cos_phi, disc * sin_phi, math_sqrt(1.0f - radial));

    ScatterSample sample;
    // Factors, not selects: comparing what a select gives keeps g++ from vectorising.
    const float specular_share = is_specular ? 1.0f : 0.0f;
    sample.wi = reflected * specular_share + cosine * (1.0f - specular_share);
    const Scatter scatter = lobes_evaluate(lobes, wo, sample.wi);
    const int is_mirror_sample = is_specular & lobes.is_mirror;
    const float3 mirrored =
        fresnel_schlick(lobes.f0, lobes.f90, wo.z) * (1.0f / math_greater(p, 1e-12f));
    const float inverse = scatter.pdf > 0.0f ? 1.0f / scatter.pdf : 0.0f;
    const float3 weight = scatter.value * inverse;
    const int is_lambert =
        vec_max_component(lobes.f0) + lobes.f90 == 0.0f;  // no rounding by the way of pdf
    sample.weight =
        make_float3(is_mirror_sample ? mirrored.x : (is_lambert ? lobes.diffuse.x : weight.x),
                    is_mirror_sample ? mirrored.y : (is_lambert ? lobes.diffuse.y : weight.y),
                    is_mirror_sample ? mirrored.z : (is_lambert ? lobes.diffuse.z : weight.z));
    sample.pdf = is_mirror_sample ? 0.0f : scatter.pdf;
    return sample;
}

// The same three for a purely diffuse surface (no metal, no specular reflection anywhere in the
// scene).
SHARED Scatter diffuse_evaluate(float3 reflectance, float3 wi)
{
    const float cosine = wi.z > 0.0f ? math_greater(wi.z, 1e-6f) : 0.0f;
    Scatter scatter;
    scatter.value = reflectance * INV_PI * cosine;
    scatter.pdf = cosine * INV_PI;
    return scatter;
}

SHARED ScatterSample diffuse_sample(float3 reflectance, float2 u)
{
    const float turn = 2.0f * u.y;
    const float disc = math_sqrt(u.x);
    ScatterSample sample;
    sample.wi =
        make_float3(disc * math_cospi(turn), disc * math_sinpi(turn), math_sqrt(1.0f - u.x));
    sample.weight = reflectance;
    sample.pdf = math_greater(sample.wi.z, 1e-6f) * INV_PI;
    return sample;
}
