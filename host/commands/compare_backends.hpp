// `diptych compare SCENE --backends A,B`: one sample plan on two backends, the pictures judged, and
// where they part, the first stage that parts them.
#pragma once

#include "host/commands/scene_flags.hpp"
#include "host/commands/trace_comparison.hpp"
#include "host/image/compare.hpp"
#include "host/render/render.hpp"

#include <iosfwd>

namespace diptych {

struct CompareBackendsCommand {
    image::CompareOptions compare;  // `backends` and, if not the demo scene, `reference`
    SceneFlags scene;
    DeviceFlags device;
    std::string bound;  // as given; empty: default_bound
    bool is_quiet = false;
};

// Where two renders of the same samples part.
struct PixelDivergence {
    Divergence divergence;
    int x, y, sample;
};

// Pixels, in the order of rendering, with a value in some layer beyond the bound. The standard
// error follows from the rest and is left out.
std::vector<Pixel> differing_pixels(const image::Picture& a, const image::Picture& b,
                                    const Bound& bound);

// Traces those pixels on both, 16 at a time, until a state parts; of the 16, the one that parts
// earliest. Empty when all states agree: then the sums differ, or only the pictures do.
std::optional<PixelDivergence> find_divergence(Backend& a, Backend& b, const SceneData& scene,
                                               int samples, const std::vector<Pixel>& pixels,
                                               const Bound& bound);

// The bound when the user gives none: the same bits, but for double precision and fast math.
Bound default_bound(const std::string& a, const std::string& b, bool fast_math);

// Adds --bound and the flags of scene and device to `compare`, all of them only with --backends.
void add_compare_backends_flags(CLI::App& compare, CompareBackendsCommand& command);

// 0: within; 1: not. Errors are thrown.
int run_compare_backends(const CompareBackendsCommand& command, std::ostream& out);

}  // namespace diptych
