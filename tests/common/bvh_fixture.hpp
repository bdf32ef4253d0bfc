// Scenes and rays for the tests of the walk, and two ways to know the answer: Embree, and testing
// every triangle.
#pragma once

#include "backends/bvh_build.hpp"
#include "common/bvh.h"

#include <vector>

struct RTCSceneTy;
struct RTCDeviceTy;

struct TestRay {
    float3 origin;
    float3 direction;
};

diptych::SceneData soup(int count, float size, float offset);  // random triangles in a unit cube
diptych::SceneData boxes(int count);                           // closed, axis-aligned
diptych::SceneData sheet(int cells, float size);               // of two triangles each
diptych::SceneData pile(int count);                            // the same triangle again and again
diptych::SceneData spiral(int count);  // sizes in geometric progression: deep trees

// The mesh leaves instance 0 and is placed `count` times at random.
void add_instances(diptych::SceneData& scene, int count);

std::vector<TestRay> random_rays(int count, float offset, unsigned seed);
std::vector<TestRay> axis_rays(int count, unsigned seed);
std::vector<TestRay> grazing_rays(int count, float size, unsigned seed);
std::vector<TestRay> edge_rays(const diptych::SceneData& box, int count, unsigned seed);

float3 box_centre(const diptych::SceneData& box);
Scene view_of(const diptych::SceneData& scene);
Hit closest_of_all(const diptych::SceneData& scene, const TestRay& ray);  // instance 0 alone
int depth_of(const diptych::SceneData& scene, int node);  // inner nodes on the longest way down

class EmbreeScene {
public:
    explicit EmbreeScene(const diptych::SceneData& scene);
    ~EmbreeScene();
    EmbreeScene(const EmbreeScene&) = delete;
    EmbreeScene& operator=(const EmbreeScene&) = delete;

    Hit closest(const TestRay& ray) const;

private:
    RTCDeviceTy* device_;
    RTCSceneTy* scene_;
};
