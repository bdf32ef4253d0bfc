// Embree without what the renderer asks beyond a fast answer: no filters, robust only if wanted.
#pragma once

#include "kernels_cpu/embree_scene.hpp"

#include <memory>
#include <vector>

namespace diptych {

// Rays in planes, `stride` values apart; readable up to a whole packet beyond `count`.
struct BareRays {
    int count;
    int stride;
    const float* origin;
    const float* direction;
    const float* distance;  // of shadow rays
};

class BareEmbree {
public:
    BareEmbree(const std::vector<EmbreeMesh>& meshes, int threads, bool is_robust);
    ~BareEmbree();
    BareEmbree(const BareEmbree&) = delete;
    BareEmbree& operator=(const BareEmbree&) = delete;

    // Traces the rays in packets; the answers are dropped. Returns how many rays hit something.
    int intersect(const BareRays& rays, bool is_coherent) const;
    int occlude(const BareRays& rays) const;

private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

}  // namespace diptych
