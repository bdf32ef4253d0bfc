// The texture stage in vector lanes, a part of texture_stage.cpp: the paths that run one program
// stand side by side, and each of its steps is one loop over them. Few paths of a program are run
// with those of others of its group, which have the same steps and differ in arguments alone.

constexpr int lane_count = 128;       // as many as keep their state in the first-level cache
constexpr int worth_a_loop = 16;      // paths of one program
constexpr int chunk_count = 1 << 10;  // paths sorted at a time

#define LANE_float(field) float field[1][lane_count];
#define LANE_float2(field) float field[2][lane_count];
#define LANE_float3(field) float field[3][lane_count];
#define LANE_float4(field) float field[4][lane_count];
#define LANE_int(field) int field[1][lane_count];
#define LANE_FIELD(name, bit, type, field) LANE_##type(field)

struct Lanes {
    int path[lane_count];
    int first_step[lane_count];  // word of the first step of the path's program
    float value[4][lane_count];
    int verdict[lane_count];  // texture_verdict of the step
    float stack[4 * TEXTURE_SLOTS][lane_count];
    TEXTURE_ATTRIBUTES(LANE_FIELD)
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

#define LOAD_float(field) lanes.field[0][k]
#define LOAD_int(field) lanes.field[0][k]
#define LOAD_float2(field) make_float2(lanes.field[0][k], lanes.field[1][k])
#define LOAD_float3(field) make_float3(lanes.field[0][k], lanes.field[1][k], lanes.field[2][k])
#define LOAD_float4(field) \
    make_float4(lanes.field[0][k], lanes.field[1][k], lanes.field[2][k], lanes.field[3][k])
#define NONE_float 0.0f
#define NONE_int 0
#define NONE_float2 make_float2(0.0f, 0.0f)
#define NONE_float3 make_float3(0.0f, 0.0f, 0.0f)
#define NONE_float4 make_float4(1.0f, 1.0f, 1.0f, 1.0f)
#define LOAD_FIELD(name, bit, type, field)                 \
    if constexpr ((TEXTURE_ASKED & ATTRIBUTE_##name) != 0) \
        tx.field = LOAD_##type(field);                     \
    else                                                   \
        tx.field = NONE_##type;

// A scene whose effects are constants and whose settings no store can change.
#define LOCAL_SCENE                           \
    Scene scene = scene_in;                   \
    scene.effects = TEXTURE_EFFECTS;          \
    const auto settings = *scene_in.settings; \
    scene.settings = &settings;               \
    const Paths paths = paths_in;

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
    for (int k = 0; k < count; ++k) fill_lane(&scene, &paths, lanes, k);
}

SHARED TextureContext context_of(const Scene* scene, const Paths* paths, const Lanes& lanes, int k)
{
    TextureContext tx;
    tx.scene = scene;
    tx.paths = paths;
    tx.path = lanes.path[k];
    TEXTURE_ATTRIBUTES(LOAD_FIELD)
    tx.stack = &lanes.stack[0][0];
    tx.stack_stride = lane_count;
    tx.lane = k;
    return tx;
}

// One step of all lanes; is_uniform: they have the same region.
#define FUNCTION_LOOP(number, id)                                                                \
    template<bool is_uniform>                                                                    \
    SHARED void id##_lane(const Scene* scene, const Paths* paths, Lanes& lanes, int k,           \
                          TextureStep step, int offset)                                          \
    {                                                                                            \
        TextureContext tx = context_of(scene, paths, lanes, k);                                  \
        texture_begin(&tx, step);                                                                \
        const int own = int(material_word(scene, lanes.first_step[k] + offset));                 \
        const auto given = user_language::id::id##_entry(&tx, is_uniform ? step.region : own);   \
        lanes.verdict[k] = texture_verdict(&tx, VALUE_OF(given));                                \
        const TextureValue value = texture_finite(VALUE_OF(given));                              \
        lanes.value[0][k] = value.r;                                                             \
        lanes.value[1][k] = value.g;                                                             \
        lanes.value[2][k] = value.b;                                                             \
        lanes.value[3][k] = value.a;                                                             \
    }                                                                                            \
    template<bool is_uniform>                                                                    \
    [[gnu::noinline]] void id##_loop(const Scene& scene_in, const Paths& paths_in, Lanes& lanes, \
                                     int count, TextureStep step, int step_number)               \
    {                                                                                            \
        LOCAL_SCENE                                                                              \
        const int offset = step_number * TEXTURE_STEP_WORDS + 1;                                 \
        _Pragma("omp simd") for (int k = 0; k < count; ++k)                                      \
            id##_lane<is_uniform>(&scene, &paths, lanes, k, step, offset);                       \
    }
TEXTURE_FUNCTIONS(FUNCTION_LOOP)

void keep(const Paths& paths, Lanes& lanes, int count, const TextureStep& step)
{
    int any = 0;
    for (int k = 0; k < count; ++k) any |= lanes.verdict[k];
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
void run_steps(const Scene& scene, const Paths& paths, Lanes& lanes, int count,
               const TextureProgram& program)
{
    fill(scene, paths, lanes, count);
    for (int k = 0; k < program.steps; ++k) {
        const TextureStep step = texture_step(&scene, program.first, k);
        switch (step.function) {
#define RUN_FUNCTION(number, id)                                    \
    case number:                                                    \
        id##_loop<is_uniform>(scene, paths, lanes, count, step, k); \
        break;
            TEXTURE_FUNCTIONS(RUN_FUNCTION)
        }
        keep(paths, lanes, count, step);
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
void run_matching(const Scene& scene, const Paths& paths, Lanes& lanes, Waiting& waiting,
                  const TextureProgram& program, const Matches& matches)
{
    int rest = 0, lane = 0;
    for (int k = 0; k < waiting.count; ++k) {
        const int word = waiting.program[k], path = waiting.path[k];
        if (matches(word)) {
            lanes.path[lane] = path;
            lanes.first_step[lane] = word + TEXTURE_PROGRAM_WORDS;
            if (++lane == lane_count) {
                run_steps<is_uniform>(scene, paths, lanes, lane, program);
                lane = 0;
            }
        } else {
            waiting.path[rest] = path;
            waiting.program[rest++] = word;
        }
    }
    if (lane > 0) run_steps<is_uniform>(scene, paths, lanes, lane, program);
    waiting.count = rest;
}

void run_waiting(const Scene& scene, const Paths& paths, Lanes& lanes, Waiting& waiting)
{
    while (waiting.count > 0) {
        const int word = waiting.program[0];
        const TextureProgram program = texture_program(&scene, word);
        int same = 0;
        for (int k = 0; k < waiting.count; ++k) same += waiting.program[k] == word ? 1 : 0;
        if (same >= worth_a_loop)
            run_matching<true>(scene, paths, lanes, waiting, program,
                               [&](int other) { return other == word; });
        else
            run_matching<false>(scene, paths, lanes, waiting, program, [&](int other) {
                return texture_program(&scene, other).group == program.group;
            });
    }
}

void run(const Scene& scene, const Paths& paths, int first, int count)
{
    thread_local Lanes lanes;
    thread_local Waiting waiting;
    const int end = first + count;
    for (int start = first; start < end; start += chunk_count) {
        const int stop = start + chunk_count < end ? start + chunk_count : end;
        int programs[chunk_count];
#pragma omp simd
        for (int i = start; i < stop; ++i)
            programs[i - start] = texture_program_of(&scene, &paths, i);
        waiting.count = 0;
        for (int i = start; i < stop; ++i) {
            waiting.path[waiting.count] = i;
            waiting.program[waiting.count] = programs[i - start];
            waiting.count += programs[i - start] != 0 ? 1 : 0;
        }
        run_waiting(scene, paths, lanes, waiting);
    }
}
