// Whether a ray is stopped by a surface with holes. The answer depends on the ray and on the
// triangle alone, not on the order in which a traversal meets triangles, so that every backend
// finds the same hit.
#pragma once

#include "common/random.h"
#include "common/surface.h"

// A number for the decisions of one ray. purpose: 0 for a path's ray, 1 for a shadow ray.
SHARED uint alpha_seed(uint seed, int pixel, int sample, int depth, int purpose)
{
    return hash_pair(hash_pair(hash_pair(seed, (uint)pixel), (uint)sample),
                     (uint)(2 * depth + purpose));
}

// Mask: alpha against the cutoff. Blend: stopped with probability alpha, which is blending on
// average.
SHARED int alpha_accepts(const Scene* scene, int instance, int triangle, float u, float v,
                         uint seed)
{
    const int material = scene->triangles[triangle].material;
    const int mode = scene->materials[material].alpha_mode;
    const float alpha = surface_base_color(scene, triangle, make_float2(u, v)).w;
    const uint bits = hash_pair(hash_pair(seed, (uint)instance), (uint)triangle);
    const float threshold = mode == ALPHA_MASK ? scene->materials[material].alpha_cutoff
                                               : uniform_from_bits(bits) + 5.9604645e-8f;
    return mode == ALPHA_OPAQUE ? 1 : alpha >= threshold;
}
