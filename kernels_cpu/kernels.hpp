// The kernels as the CPU backends call them: loops over a range of paths, one per stage, from the
// same sources as OpenCL's.
#pragma once

#include "common/stages/stages.h"

namespace diptych {

// The views of common/buffers.h without their element types, which differ between dialects: buffers
// in the order of the rows. Float planes hold float or double, as the kernel set's real_bytes says.
struct SceneView {
    unsigned effects = 0;
    const void* const* buffers = nullptr;
    const struct TextureKernels* textures = nullptr;  // where the scene calls for procedural ones
};
struct PathView {
    int capacity = 0;
    int results = 0;
    int samples = 0;
    int pixel_shift = 0;
    int turn = 0;
    int lookup = 0;
    const void* items = nullptr;  // WorkItem
    void* const* planes = nullptr;
    void* const* result_planes = nullptr;
    void* const* texture_planes = nullptr;         // one of each row of TEXTURE_BUFFERS
    void* const* texture_result_planes = nullptr;  // likewise, TEXTURE_RESULT_BUFFERS
};

// Runs a stage for paths (or results) first .. first + count - 1.
using StageLoop = void (*)(const SceneView&, const PathView&, int first, int count);

// What a step of a texture's program did, for who looks at one path.
struct TextureStepSeen {
    int number;           // of the step
    const double* stack;  // four of each slot, before it
    double value[4];      // what it gave, as it gave it
    int fault_line;       // see TextureContext
    int clamped;
};
using TextureWatch = void (*)(void* watcher, const TextureStepSeen&);

// The stage that holds user code: compiled while the program runs (backends/textures), for one
// scene and one kernel set.
struct TextureKernels {
    StageLoop evaluate = nullptr;
    // The same for one path, step by step; not there where the stage is vectorised.
    void (*watch)(const SceneView&, const PathView&, int path, TextureWatch,
                  void* watcher) = nullptr;
    int planes[7] = {};  // of each row of TEXTURE_BUFFERS
};

struct KernelSet {
    const char* name;
    int real_bytes;
    // The loop for a stage; nullptr for native stages that the set does not have. Loops specialised
    // for some effects are chosen by `effects`; which buffers such a loop may read beyond those of
    // `effects` says covered_effects.
    StageLoop (*loop)(Stage stage, unsigned effects);
    // Of a stage each_surface: what takes its place where rays have met nothing; nullptr for
    // others.
    StageLoop (*missed)(Stage stage);
    unsigned (*covered_effects)(unsigned effects);
};

// Vectorised across paths, for the widest vectors that this machine has and the build provides; no
// intersection (Embree does it).
const KernelSet& vector_kernels();

namespace kernels_scalar {  // the same sources, scalar, with the BVH walk: what OpenCL runs
extern const KernelSet set;
}
namespace kernels_debug {  // kernels_scalar for a debugger: -O0 -g, nothing inlined
extern const KernelSet set;
}
namespace kernels_reference {  // in double precision
extern const KernelSet set;
}

}  // namespace diptych
