#include "backends/textures/texture_replay.hpp"

#include "backends/bvh_build.hpp"
#include "backends/textures/native_stage.hpp"
#include "backends/textures/texture_tool.hpp"
#include "common/as_cpp/path_rows.hpp"
#include "common/as_cpp/texture_lookups.hpp"
#include "common/textures/procedural.h"
#include "kernels_cpu/kernels.hpp"

#include <algorithm>
#include <bit>
#include <stdexcept>

namespace diptych {
namespace {

constexpr int capacity = 16;
alignas(64) const unsigned char zeros[256] = {};

uint word_of(const SceneData& scene, size_t word)
{
    return reinterpret_cast<const uint*>(scene.materials.data())[word];
}

int program_of(const SceneData& scene, int triangle, int lookup)
{
    return scene.materials.at(size_t(scene.triangles.at(size_t(triangle)).material))
        .texture_program[texture_program_asked(lookup)];
}

// An argument's numbers, out of the stack or the words of its region.
std::vector<double> argument_of(const SceneData& scene, const TextureArgument& argument, int at,
                                const double* stack)
{
    const int source = int(word_of(scene, size_t(at)));
    const size_t first = word_of(scene, size_t(at) + 1), length = word_of(scene, size_t(at) + 2);
    const size_t width = size_t(width_of(argument)), stride = width == 3 ? 4 : width;
    if (source >= 0) return {stack + 4 * source, stack + 4 * source + width};
    std::vector<double> numbers;
    for (size_t k = 0; k < std::max<size_t>(length, 1); ++k)
        for (size_t c = 0; c < width; ++c) {
            const uint word = word_of(scene, first + k * stride + c);
            if (argument.type.starts_with("float"))
                numbers.push_back(double(std::bit_cast<float>(word)));
            else if (argument.type.starts_with("uint"))
                numbers.push_back(double(word));
            else
                numbers.push_back(double(int(word)));
        }
    return numbers;
}

// The functions' text with notes in it; as it was, where the file is not there any more.
std::vector<TextureFunction> watched(std::vector<TextureFunction> functions,
                                     const std::string& what)
{
    for (TextureFunction& function : functions) {
        try {
            function.cpp =
                translate_texture({function.file, function.file, function.entry, function.id, what})
                    .cpp;
        } catch (const std::runtime_error&) {
            continue;
        }
    }
    return functions;
}

std::unique_ptr<NativeStage> stage_of(SceneData& scene, bool is_double, TextureReplay::Build build,
                                      const GeneratedFolders& generated)
{
    NativeStageOptions options;
    options.generated_dir = generated.write;
    options.use_generated = generated.use;
    options.kind = is_double ? NativeStageKind::reference : NativeStageKind::scalar;
    options.is_debug = build == TextureReplay::Build::debug;
    const bool has_values = build == TextureReplay::Build::watched_values;
    if (!has_values && build != TextureReplay::Build::watched_indexes)
        return std::make_unique<NativeStage>(scene, options);
    struct Exchanged {  // for as long as the stage is made
        std::vector<TextureFunction>& functions;
        std::vector<TextureFunction> own;
        ~Exchanged() { functions.swap(own); }
    } exchanged{scene.textures.functions,
                watched(scene.textures.functions, has_values ? "values" : "indexes")};
    exchanged.functions.swap(exchanged.own);
    return std::make_unique<NativeStage>(scene, options);
}

}  // namespace

std::vector<TexturedPath> textured_hits(const SceneData& scene, const StageState& state, int lookup)
{
    std::vector<TexturedPath> hits;
    const size_t paths = size_t(state.paths);
    for (size_t p = 0; p < paths; ++p) {
        const auto number = [&](int row, size_t c = 0) {
            return state.planes[size_t(row)].at(c * paths + p);
        };
        const int triangle = int(number(row_hit_triangle));
        if (number(row_depth) < 0 || triangle < 0) continue;
        if (program_of(scene, triangle, lookup) == 0) continue;
        TextureHit hit{int(number(row_pixel)),
                       int(number(row_sample)),
                       int(number(row_depth)),
                       triangle,
                       int(number(row_hit_instance)),
                       {},
                       {}};
        for (size_t c = 0; c < 3; ++c) {
            hit.origin[c] = number(row_ray_origin, c);
            hit.direction[c] = number(row_ray_direction, c);
        }
        hits.push_back({int(p), hit});
    }
    return hits;
}

struct TextureReplay::Implementation {
    SceneData& scene;
    const KernelSet& kernels;
    std::unique_ptr<NativeStage> stage;
    std::vector<const void*> buffers;
    std::vector<std::vector<unsigned char>> memory;
    std::vector<void*> planes, texture_planes;
    SceneView scene_view;
    PathView path_view;
    WorkItem item{};

    Implementation(SceneData& scene_in, bool is_double, Build build,
                   const GeneratedFolders& generated)
        : scene(scene_in), kernels(is_double ? kernels_reference::set : kernels_scalar::set),
          stage(stage_of(scene_in, is_double, build, generated))
    {
        if (!stage->kernels().watch)
            throw std::runtime_error("procedural textures: the compiled stage is of another "
                                     "version; empty the cache folder");
        if ((scene.effects & EFFECT_TEXTURE_OCCLUSION) && scene.bvh_nodes.empty()) build_bvh(scene);
#define BIND(type, name) \
    buffers.push_back(scene.name.empty() ? static_cast<const void*>(zeros) : scene.name.data());
        SCENE_BUFFERS(BIND)
#undef BIND
        scene_view = {scene.effects, buffers.data(), &stage->kernels()};
        const auto add = [&](std::vector<void*>& to, int components) {
            memory.emplace_back(size_t(components) * capacity * sizeof(double) + 64);
            to.push_back(memory.back().data());
        };
        for (const PathRow& row : path_rows) add(planes, row.components);
        for (const int count : diptych::texture_planes(scene)) add(texture_planes, count);
        path_view.capacity = capacity;
        path_view.samples = 1;
        path_view.items = &item;
        path_view.planes = planes.data();
        path_view.texture_planes = texture_planes.data();
    }

    void set(int row, int value) { *static_cast<int*>(planes[size_t(row)]) = value; }
    void set(int row, const std::array<double, 3>& value)
    {
        for (size_t c = 0; c < 3; ++c) {
            if (kernels.real_bytes == 8)
                static_cast<double*>(planes[size_t(row)])[c * capacity] = value[c];
            else
                static_cast<float*>(planes[size_t(row)])[c * capacity] = float(value[c]);
        }
    }
};

TextureReplay::TextureReplay(SceneData& scene, bool is_double, Build build,
                             const GeneratedFolders& generated)
    : implementation_(std::make_unique<Implementation>(scene, is_double, build, generated))
{
}

TextureReplay::~TextureReplay() = default;

std::vector<TextureStepValue> TextureReplay::run(const TextureHit& hit, int lookup)
{
    Implementation& own = *implementation_;
    own.path_view.lookup = lookup;
    own.set(row_pixel, hit.pixel);
    own.set(row_sample, hit.sample);
    own.set(row_depth, hit.depth);
    own.set(row_hit_triangle, hit.triangle);
    own.set(row_hit_instance, hit.instance);
    own.set(row_ray_origin, hit.origin);
    own.set(row_ray_direction, hit.direction);
    look_up_distances(own.scene.effects, lookup, [&](Stage, int asked) {
        PathView view = own.path_view;
        view.lookup = asked;
        own.stage->kernels().evaluate(own.scene_view, view, 0, 1);
    });
    if (own.scene.effects & EFFECT_TEXTURE_OCCLUSION)
        own.kernels.loop(STAGE_trace_texture_rays, own.scene.effects)(own.scene_view, own.path_view,
                                                                      0, 1);
    struct Watcher {
        const SceneData& scene;
        int first_step;
        std::vector<TextureStepValue> steps;
    } watcher{own.scene, program_of(own.scene, hit.triangle, lookup) + TEXTURE_PROGRAM_WORDS, {}};
    const auto see = [](void* to, const TextureStepSeen& seen) {
        Watcher& watching = *static_cast<Watcher*>(to);
        const SceneData& scene = watching.scene;
        const size_t word = size_t(watching.first_step + seen.number * TEXTURE_STEP_WORDS);
        const int region = int(word_of(scene, word + 1));
        const auto at =
            std::ranges::find(scene.textures.attachments, region, &TextureAttachment::first_word);
        TextureStepValue step;
        step.attachment = int(at - scene.textures.attachments.begin());
        step.outputs = int(word_of(scene, word + 3));
        step.fault_line = seen.fault_line;
        step.clamped = seen.clamped;
        std::ranges::copy(seen.value, step.value.begin());
        int descriptor = region;
        const TextureFunction& function = scene.textures.functions.at(size_t(at->function));
        for (const TextureArgument& argument : function.arguments) {
            step.arguments.push_back(argument_of(scene, argument, descriptor, seen.stack));
            descriptor += TEXTURE_DESCRIPTOR_WORDS;
        }
        watching.steps.push_back(std::move(step));
    };
    own.stage->kernels().watch(own.scene_view, own.path_view, 0, see, &watcher);
    return std::move(watcher.steps);
}

}  // namespace diptych
