// The pipeline, in order of execution: one row a stage.
#pragma once

#include "common/effects.h"

#define LIGHT_EFFECTS (EFFECT_EMISSION | EFFECT_PUNCTUAL_LIGHTS | EFFECT_ENVIRONMENT)

// X(name, body, when, needs)
//   body: shared - common/stages/NAME.h, the same source on every backend;
//         native - written for each kind of device
//   when: once - at the start; each_bounce - until no path is alive; first_bounce - in the first of
//         these only, at its place in the order; each_surface - each bounce, of paths whose ray has
//         met something: NAME_missed(scene, paths, i) leaves of the others what is read later;
//         each_layer - of surfaces whose alpha a texture gives: between the rounds of intersect
//         and of occlusion; at_end - over result entries, not paths, once for each of
//         Paths::samples with Paths::turn counting up; its NAME_path(scene, paths, i, result,
//         sample) is the same for one path, where paths end one by one
//   needs: effects of which the scene must call for one, else the stage is neither compiled nor
//         launched; 0: always
#define STAGES(X)                                                        \
    X(generate_paths, shared, once, 0)                                   \
    X(intersect, native, each_bounce, 0)                                 \
    X(decide_alpha, shared, each_layer, EFFECT_PROCEDURAL_ALPHA)         \
    X(trace_texture_rays, native, each_bounce, EFFECT_TEXTURE_OCCLUSION) \
    X(evaluate_textures, native, each_bounce, EFFECT_PROCEDURAL)         \
    X(evaluate_surface, shared, each_surface, 0)                         \
    X(record_features, shared, first_bounce, 0)                          \
    X(add_emission, shared, each_bounce, LIGHT_EFFECTS | EFFECT_UNLIT)   \
    X(sample_light, shared, each_surface, LIGHT_EFFECTS)                 \
    X(scale_light, shared, each_bounce, EFFECT_PROCEDURAL_EMISSION)      \
    X(occlusion, native, each_bounce, LIGHT_EFFECTS)                     \
    X(sample_bsdf, shared, each_surface, 0)                              \
    X(compact, native, each_bounce, 0)                                   \
    X(accumulate, shared, at_end, 0)                                     \
    X(accumulate_aovs, shared, at_end, EFFECT_TEXTURE_AOV)

#define STAGE_NUMBER(name, body, when, needs) STAGE_##name,
typedef enum { STAGES(STAGE_NUMBER) STAGE_COUNT } Stage;
