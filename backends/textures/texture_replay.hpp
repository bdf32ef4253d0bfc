// One hit again on the host, its material's textures step by step: what each was given, and what
// it gave before anything was replaced.
#pragma once

#include "backends/backend.hpp"
#include "backends/textures/texture_source.hpp"

#include <array>
#include <memory>
#include <vector>

namespace diptych {

// All that the texture stage reads of a path.
struct TextureHit {
    int pixel = 0;  // x | y << 16
    int sample = 0;
    int depth = 0;
    int triangle = -1;
    int instance = 0;
    std::array<double, 3> origin{};  // of the ray, world space
    std::array<double, 3> direction{};
};

struct TextureStepValue {
    int attachment = 0;  // into SceneTextures::attachments
    int outputs = 0;     // see TextureStep
    std::vector<std::vector<double>>
        arguments;  // numbers of each, arrays whole; images: their slot
    std::array<double, 4> value{};
    int fault_line = 0;  // see TextureContext
    int clamped = 0;
};

// The hits that the paths of a state have after STAGE_intersect on materials with textures, with
// the number of the path. lookup: LOOKUP_SURFACE, or LOOKUP_AOV for textures that layers show.
struct TexturedPath {
    int path;
    TextureHit hit;
};
std::vector<TexturedPath> textured_hits(const SceneData& scene, const StageState& state,
                                        int lookup = LOOKUP_SURFACE);

class TextureReplay {
public:
    enum class Build {
        plain,
        debug,            // for a debugger
        watched_values,   // fault_line is where one first was not finite, in files that can be read
        watched_indexes,  // or where one was out of range
    };
    // is_double: in double precision. Completes the scene, which must outlive this, with its tree
    // where textures ask for occlusion.
    TextureReplay(SceneData& scene, bool is_double, Build build = Build::plain,
                  const GeneratedFolders& generated = {});
    ~TextureReplay();
    TextureReplay(const TextureReplay&) = delete;
    TextureReplay& operator=(const TextureReplay&) = delete;

    std::vector<TextureStepValue> run(const TextureHit& hit, int lookup = LOOKUP_SURFACE);

private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

}  // namespace diptych
