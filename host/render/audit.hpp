// The error of a finished picture as independent samples find it.
#pragma once

#include "host/render/render.hpp"

#include <functional>
#include <optional>

namespace diptych {

struct Audit {
    int blocks = 0;      // that were rendered again
    int chosen = 0;      // that were to be
    double rms = 0;      // JND, of all their pixels
    double rms_low = 0;  // ends of its 95 % interval
    double rms_high = 0;
    double share_within = 0;              // of the pixels: nearer to the new ones than `bar`
    std::optional<double> share_covered;  // of those predicted to be within `bar`: were so
    std::optional<double> share_false;  // of the blocks predicted below `bar`: have an RMS above it
    double seconds = 0;
};

// Renders about one block in sixteen anew, eight or so at least, by another seed and four times the
// samples, and compares. The noise that the new samples have themselves is taken off the RMS, not
// off the shares. Uploads the scene again, and leaves it uploaded with its own seed.
// tell: before each block and at the end, how many are done and are to be.
Audit audit(Backend& backend, SceneData& scene, const RenderOptions& options,
            const RenderResult& result, double bar,
            const std::function<void(int done, int of, bool is_end)>& tell = {});

}  // namespace diptych
