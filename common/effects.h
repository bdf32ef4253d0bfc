// The effects that a scene may call for. What no material, light or camera of the scene asks for is
// compiled out of the OpenCL programs, skipped on the CPU, and changes no pixel by its absence.
#pragma once

// X(name, bit, what it is, in words for `diptych explain`)
#define EFFECTS_LIST(X)                                                      \
    X(SPECULAR, 0, "specular reflection (GGX), from metals and dielectrics") \
    X(BASE_TEXTURE, 1, "base colour textures")                               \
    X(SURFACE_TEXTURES, 2, "metallic, roughness and specular textures")      \
    X(NORMAL_MAP, 3, "normal maps")                                          \
    X(EMISSION, 4, "emissive surfaces")                                      \
    X(EMISSION_TEXTURE, 5, "textured emission")                              \
    X(PUNCTUAL_LIGHTS, 6, "point, spot and directional lights")              \
    X(ENVIRONMENT, 7, "an environment or sky")                               \
    X(INSTANCES, 8, "meshes placed more than once")                          \
    X(SMOOTH_NORMALS, 9, "vertex normals")                                   \
    X(VERTEX_COLOR, 10, "vertex colours")                                    \
    X(ALPHA, 11, "alpha masks and blending")                                 \
    X(UNLIT, 12, "unlit materials")                                          \
    X(FLOAT_TEXTURES, 13, "textures of 16 bit or float")                     \
    X(ORTHOGRAPHIC, 14, "an orthographic camera")                            \
    X(PROCEDURAL, 15, "procedural textures")                                 \
    X(TEXTURE_OCCLUSION, 16, "occlusion that textures ask for")              \
    X(PROCEDURAL_EMISSION, 17, "procedural textures on lights")              \
    X(PROCEDURAL_ALPHA, 18, "alpha from procedural textures")                \
    X(TEXTURE_AOV, 19, "layers that show texture nodes")                     \
    X(OCCLUSION_DISTANCE, 20, "occlusion whose distance a texture gives")

#define EFFECT_BIT(name, bit, words) EFFECT_##name = 1 << bit,
enum { EFFECTS_LIST(EFFECT_BIT) };

// What calls for users' code, and for the stages about it.
#define USER_TEXTURE_EFFECTS \
    (EFFECT_PROCEDURAL | EFFECT_TEXTURE_OCCLUSION | RECORD_EFFECTS | ASIDE_EFFECTS)

// What textures are run for aside from what surfaces read.
#define ASIDE_EFFECTS (EFFECT_TEXTURE_AOV | EFFECT_OCCLUSION_DISTANCE)

// What asks textures away from the place that a path has met.
#define RECORD_EFFECTS (EFFECT_PROCEDURAL_EMISSION | EFFECT_PROCEDURAL_ALPHA)
