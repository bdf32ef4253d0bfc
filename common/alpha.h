// Whether a ray is stopped by a surface with holes. The answer depends on the ray and on the
// triangle alone, not on the order in which a traversal meets triangles, so that every backend
// finds the same hit.
//
// No traversal runs users' code. Where a texture gives the alpha, a traversal stops at the surface
// and leaves a record; the texture stage is asked for it, decide_alpha makes up the ray's mind, and
// if the surface lets it through, the traversal goes on behind the record: round after round, as
// many as there are such surfaces one behind another (common/as_cpp/texture_lookups.hpp).
#pragma once

#include "common/random.h"
#include "common/surface.h"

// A number for the decisions of one ray. purpose: 0 for a path's ray, 1 for a shadow ray.
SHARED uint alpha_seed(uint seed, int pixel, int sample, int depth, int purpose)
{
    return hash_pair(hash_pair(hash_pair(seed, (uint)pixel), (uint)sample),
                     (uint)(2 * depth + purpose));
}

// Whether a texture gives the surface's alpha, so that it has to be asked.
SHARED int alpha_is_asked(const Scene* scene, int triangle)
{
    const int material = ROW_AT(scene, triangles, triangle).material;
    return scene->materials[material].texture_program[PROGRAM_ALPHA] != 0;
}

// Mask: alpha against the cutoff. Blend: stopped with probability alpha, which is blending on
// average.
SHARED int alpha_stops(const Scene* scene, int instance, int triangle, float alpha, uint seed)
{
    const int material = ROW_AT(scene, triangles, triangle).material;
    const int mode = scene->materials[material].alpha_mode;
    const uint bits = hash_pair(hash_pair(seed, (uint)instance), (uint)triangle);
    const float threshold = mode == ALPHA_MASK ? scene->materials[material].alpha_cutoff
                                               : uniform_from_bits(bits) + 5.9604645e-8f;
    return mode == ALPHA_OPAQUE ? 1 : alpha >= threshold;
}

// The traversals' question; what a texture decides stops them.
SHARED int alpha_accepts(const Scene* scene, int instance, int triangle, float u, float v,
                         uint seed)
{
    const float alpha = surface_base_color(scene, triangle, make_float2(u, v)).w;
    const int stops = alpha_stops(scene, instance, triangle, alpha, seed);
    if (!uses(scene, EFFECT_PROCEDURAL_ALPHA)) return stops;
    return stops | alpha_is_asked(scene, triangle);
}
