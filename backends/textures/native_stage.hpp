// The texture stage as machine code of this processor: made by the system's C++ compiler when a
// scene calls for it, kept in the cache folder, loaded as a shared object.
#pragma once

#include "backends/scene_data.hpp"
#include "kernels_cpu/kernels.hpp"
#include "kernels_cpu/texture_tracer.hpp"

#include <memory>
#include <string>

namespace diptych {

// How the stage is compiled: to match a kernel set; silent: quickly, and so that no debugger stops
// in it, for what is asked before the rendering.
enum class NativeStageKind { vector, scalar, reference, silent };

struct NativeStageOptions {
    NativeStageKind kind = NativeStageKind::scalar;
    bool is_debug = false;        // not optimised; the same bits
    std::string generated_dir{};  // also write the generated code there
    std::string use_generated{};  // compile the (edited) code that lies there instead
    int most_seconds = 120;       // of the compiler over one texture; one is usual
};

// A loaded stage. Its code stays as long as this lives.
class NativeStage {
public:
    // Throws std::runtime_error: no compiler, or its messages, which name the user's own lines.
    NativeStage(const SceneData& scene, const NativeStageOptions& options);
    ~NativeStage();
    NativeStage(const NativeStage&) = delete;
    NativeStage& operator=(const NativeStage&) = delete;

    const TextureKernels& kernels() const { return kernels_; }
    // What traces the rays of textures that do so themselves.
    void set_tracer(decltype(TracingTextureKernels::openness) openness, const void* tracer)
    {
        kernels_.openness = openness;
        kernels_.tracer = tracer;
    }
    bool was_compiled() const { return was_compiled_; }  // else it came from the cache

private:
    void* library_ = nullptr;
    TracingTextureKernels kernels_;
    bool was_compiled_ = false;
};

// Compilations of texture stages, for any device, since the program began: what an argument's
// change does not raise.
unsigned long texture_compilations();
void count_texture_compilation();

}  // namespace diptych
