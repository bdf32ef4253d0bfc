// The texture stage in vector lanes (see texture_lanes.hpp): paths are sorted by their programs,
// and the steps of each run for up to lane_count of them at a time. Few paths of a program are run
// with those of others of its group, which have the same steps and differ in arguments alone.
// Compiled as texture_stage.cpp is; the texts of the functions are not needed here.
#include <cstddef>
#include <cstring>

#include TEXTURE_FUNCTIONS_FILE
#include "kernels_cpu/texture_lanes.hpp"

#define DECLARE_LOOPS(number, id)       \
    TEXTURE_LOOP(SAME_REGION_LOOP(id)); \
    TEXTURE_LOOP(ANY_REGION_LOOP(id));
TEXTURE_FUNCTIONS(DECLARE_LOOPS)

namespace {

using diptych::PathView;
using diptych::SceneView;

#include "kernels_cpu/typed_views.hpp"

constexpr int worth_a_loop = 16;      // paths of one program
constexpr int chunk_count = 1 << 10;  // paths sorted at a time

// What the stage is called for.
struct Evaluated {
    const SceneView& scene_view;
    const PathView& path_view;
    Scene scene;
    Paths paths;
};

#define STORE_float(field) lanes.field[0][k] = tx.field;
#define STORE_int(field) lanes.field[0][k] = tx.field;
#define STORE_float2(field) lanes.field[0][k] = tx.field.x, lanes.field[1][k] = tx.field.y;
#define STORE_float3(field) STORE_float2(field) lanes.field[2][k] = tx.field.z;
#define STORE_float4(field) STORE_float3(field) lanes.field[3][k] = tx.field.w;
#define STORE_FIELD(name, bit, type, field)                  \
    if constexpr ((TEXTURE_ASKED & ATTRIBUTE_##name) != 0) { \
        STORE_##type(field)                                  \
    }

// Bodies of loops are functions: a local variable of the loop itself would become an array of as
// many as there are lanes, and stay in memory.
SHARED void fill_lane(const Scene* scene, const Paths* paths, Lanes& lanes, int k)
{
    const TextureContext tx = texture_context(scene, paths, lanes.path[k], TEXTURE_ASKED);
    TEXTURE_ATTRIBUTES(STORE_FIELD)
}

[[gnu::noinline]] void fill(const Scene& scene_in, const Paths& paths_in, Lanes& lanes, int count)
{
    LOCAL_SCENE
#pragma omp simd
    for (int k = 0; k < whole_vectors(count); ++k) fill_lane(&scene, &paths, lanes, k);
}

SHARED void judge_lane(Lanes& lanes, int k)
{
    const TextureValue given = {lanes.value[0][k], lanes.value[1][k], lanes.value[2][k],
                                lanes.value[3][k]};
    lanes.verdict[k] = texture_verdict(lanes.verdict[k], given);
    const TextureValue value = texture_finite(given);
    lanes.value[0][k] = value.r;
    lanes.value[1][k] = value.g;
    lanes.value[2][k] = value.b;
    lanes.value[3][k] = value.a;
}

// A loop of its own: g++ would draw the question whether a clamped result is finite into the clamp,
// as a choice between truths, for which it knows no vector instruction.
int judge(Lanes& lanes, int count)
{
    int any = 0;
#pragma omp simd
    for (int k = 0; k < whole_vectors(count); ++k) judge_lane(lanes, k);
    for (int k = 0; k < count; ++k) any |= lanes.verdict[k];
    return any;
}

void keep(const Paths& paths, Lanes& lanes, int count, const TextureStep& step)
{
    const int any = judge(lanes, count);
    for (int k = 0; any != 0 && k < count; ++k)
        if (lanes.verdict[k] != 0) texture_count(&paths, lanes.path[k], lanes.verdict[k]);
    for (int c = 0; c < 4 && step.slot >= 0; ++c)
        std::memcpy(lanes.stack[4 * step.slot + c], lanes.value[c], sizeof lanes.value[c]);
    const auto store = [&](float* planes, int first, int components) {
        for (int c = 0; c < components; ++c) {
            float* plane = planes + (first + c) * paths.capacity;
            for (int k = 0; k < count; ++k) plane[lanes.path[k]] = lanes.value[c][k];
        }
    };
    if (step.aov >= 0) store(paths.first_aov, 4 * step.aov, 4);
    if (step.distance >= 0) store(paths.request_distance, step.distance, 1);
    for (int output = 0; output < SLOT_COUNT; ++output)
        if ((step.outputs >> output & 1) != 0) store(paths.texture_result, 4 * output, 4);
}

template<bool is_uniform>
void run_steps(const Evaluated& all, Lanes& lanes, int count, const TextureProgram& program)
{
    for (int k = count; k < whole_vectors(count); ++k) {
        lanes.path[k] = lanes.path[count - 1];
        lanes.first_step[k] = lanes.first_step[count - 1];
    }
    fill(all.scene, all.paths, lanes, count);
    for (int k = 0; k < program.steps; ++k) {
        const TextureStep step = texture_step(&all.scene, program.first, k);
        switch (step.function) {
#define RUN_FUNCTION(number, id)                                                                 \
    case number:                                                                                 \
        (is_uniform ? SAME_REGION_LOOP(id) : ANY_REGION_LOOP(id))(all.scene_view, all.path_view, \
                                                                  lanes, count, step, k);        \
        break;
            TEXTURE_FUNCTIONS(RUN_FUNCTION)
        }
        keep(all.paths, lanes, count, step);
    }
}

// Paths that have textures to run, with their programs.
struct Waiting {
    int path[chunk_count];
    int program[chunk_count];
    int count = 0;
};

// Takes those that match out of the list, in order, a block of lanes at a time.
template<bool is_uniform, typename Matches>
void run_matching(const Evaluated& all, Lanes& lanes, Waiting& waiting,
                  const TextureProgram& program, const Matches& matches)
{
    int rest = 0, lane = 0;
    for (int k = 0; k < waiting.count; ++k) {
        const int word = waiting.program[k], path = waiting.path[k];
        if (matches(word)) {
            lanes.path[lane] = path;
            lanes.first_step[lane] = word + TEXTURE_PROGRAM_WORDS;
            if (++lane == lane_count) {
                run_steps<is_uniform>(all, lanes, lane, program);
                lane = 0;
            }
        } else {
            waiting.path[rest] = path;
            waiting.program[rest++] = word;
        }
    }
    if (lane > 0) run_steps<is_uniform>(all, lanes, lane, program);
    waiting.count = rest;
}

void run_waiting(const Evaluated& all, Lanes& lanes, Waiting& waiting)
{
    while (waiting.count > 0) {
        const int word = waiting.program[0];
        const TextureProgram program = texture_program(&all.scene, word);
        int same = 0;
        for (int k = 0; k < waiting.count; ++k) same += waiting.program[k] == word ? 1 : 0;
        if (same >= worth_a_loop)
            run_matching<true>(all, lanes, waiting, program,
                               [&](int other) { return other == word; });
        else
            run_matching<false>(all, lanes, waiting, program, [&](int other) {
                return texture_program(&all.scene, other).group == program.group;
            });
    }
}

void run(const Evaluated& all, int first, int count)
{
    thread_local Lanes lanes;
    thread_local Waiting waiting;
    const int end = first + count;
    for (int start = first; start < end; start += chunk_count) {
        const int stop = start + chunk_count < end ? start + chunk_count : end;
        int programs[chunk_count];
#pragma omp simd
        for (int i = start; i < stop; ++i)
            programs[i - start] = texture_program_of(&all.scene, &all.paths, i);
        waiting.count = 0;
        for (int i = start; i < stop; ++i) {
            waiting.path[waiting.count] = i;
            waiting.program[waiting.count] = programs[i - start];
            waiting.count += programs[i - start] != 0 ? 1 : 0;
        }
        run_waiting(all, lanes, waiting);
    }
}

}  // namespace

extern "C" __attribute__((visibility("default"))) void
diptych_evaluate_textures(const SceneView& scene_view, const PathView& path_view, int first,
                          int count)
{
    run({scene_view, path_view, scene_from(scene_view), paths_from(path_view)}, first, count);
}
