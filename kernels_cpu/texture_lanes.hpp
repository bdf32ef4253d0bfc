// The texture stage in vector lanes: the paths that run one program stand side by side, and each of
// its steps is one loop over them. texture_lanes.cpp does all but the steps, texture_loop.cpp is
// the step of one function; this is what they share. They are objects of their own, so that
// compilers work side by side, and an edit of one texture compiles its own loops alone. Read where
// TEXTURE_ASKED, TEXTURE_SLOTS and TEXTURE_EFFECTS are known.
#pragma once

#include "kernels_cpu/kernels.hpp"

#include "platform.h"

#include "common/textures/procedural.h"

constexpr int lane_count = 128;  // as many as keep their state in the first-level cache

// Loops run over whole vectors, so that compilers make no second and third loop for the rest: the
// lanes behind the last path are those of that path again.
constexpr int whole_vectors(int count) { return (count + 15) & ~15; }

#define LANE_float(field) float field[1][lane_count];
#define LANE_float2(field) float field[2][lane_count];
#define LANE_float3(field) float field[3][lane_count];
#define LANE_float4(field) float field[4][lane_count];
#define LANE_int(field) int field[1][lane_count];
#define LANE_FIELD(name, bit, type, field) LANE_##type(field)

struct Lanes {
    int path[lane_count];
    int first_step[lane_count];  // word of the first step of the path's program
    float value[4][lane_count];  // that the step gave
    int verdict[lane_count];     // texture_faults_on_the_way, then texture_verdict
    float stack[4 * TEXTURE_SLOTS][lane_count];
    TEXTURE_ATTRIBUTES(LANE_FIELD)
};

// The loops of a function, one for lanes that have the same region and one for any: a step of all
// lanes.
#define SAME_REGION_LOOP(id) texture_loop_##id##_of_one
#define ANY_REGION_LOOP(id) texture_loop_##id##_of_any
#define TEXTURE_LOOP(name)                                                                         \
    extern "C" void name(const diptych::SceneView& scene_view, const diptych::PathView& path_view, \
                         Lanes& lanes, int count, TextureStep step, int step_number)

// A scene whose effects are constants and whose settings no store can change.
#define LOCAL_SCENE                           \
    Scene scene = scene_in;                   \
    scene.effects = TEXTURE_EFFECTS;          \
    const auto settings = *scene_in.settings; \
    scene.settings = &settings;               \
    const Paths paths = paths_in;
