// The scene in Embree's hands, and the native stages of the `cpu` backend: over the live paths,
// camera and shadow rays in packets of 8 or 16, scattered rays one by one.
#pragma once

#include "kernels_cpu/kernels.hpp"

#include <memory>
#include <string>

namespace diptych {

// One mesh placed in the world, as Embree needs it. Memory is shared, not copied: it must outlive
// the EmbreeScene and be readable 16 bytes beyond the last vertex.
struct EmbreeMesh {
    const float* positions;  // x, y, z, unused; all vertices of the scene
    size_t vertex_count;
    const int* triangles;  // vertex indices and material, four ints a triangle: this mesh's first
    int triangle_count;
    int first_triangle;     // in the scene
    const float* to_world;  // 3 rows of 4, or nullptr for the mesh that lies in world space already
};

class EmbreeScene {
public:
    // effects: of the scene, those of alpha matter.
    EmbreeScene(const EmbreeMesh* meshes, int count, int threads, unsigned effects);
    ~EmbreeScene();
    EmbreeScene(const EmbreeScene&) = delete;
    EmbreeScene& operator=(const EmbreeScene&) = delete;

    // Closest hits of paths 0 .. count - 1 into hit_triangle and hit_instance; -1 for dead paths
    // and misses. Returns the number of rays. Views whose lookup is not LOOKUP_SURFACE: those that
    // have a record go on behind it.
    int intersect(const SceneView&, const PathView&, int count, bool is_coherent) const;
    // Shadow rays of the paths whose light contribution is not black. Returns their number. A view
    // without records takes surfaces whose alpha a texture gives for solid.
    int occlusion(const SceneView&, const PathView&, int count) const;
    // Shadow rays 0 .. count - 1, all of them, of which neighbours have much of their way in
    // common.
    void occlusion_of_neighbours(const SceneView&, const PathView&, int count) const;

    size_t bytes() const;  // what Embree allocated
    static std::string version();

private:
    void find_asked(const SceneView&, const PathView&, const int* list, int count) const;

    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

}  // namespace diptych
