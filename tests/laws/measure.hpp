// Renders a scene of a law and says what it measured, with its statistical error: on every backend.
#pragma once

#include "backends/backend.hpp"
#include "host/scene/scene_builder.hpp"

#include <gtest/gtest.h>

#include <array>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace laws {

inline constexpr int batches = 8;  // scrambled independently, see common/random.h
inline constexpr int round_samples = batches * QUANTUM;

struct Measurement {
    std::vector<double> pixels;              // mean radiance of each, the green channel
    std::array<double, batches> of_batch{};  // mean of the picture over the samples of a batch
    unsigned long long faults = 0;           // samples that were not finite

    double mean() const;
    double sigma() const;  // standard error of mean()
};

// Of two measurements of the same paths: a - b, batch by batch.
Measurement difference(const Measurement& a, const Measurement& b);

// Uploads and renders `rounds` times round_samples samples a pixel.
Measurement measure(diptych::Backend& backend, diptych::SceneData& scene, int rounds = 1);

// |mean - truth| <= 4 sigma + (0.1 % + `allowance`) of truth; and sigma must be small enough, one
// per cent of truth, for that to say something.
testing::AssertionResult obeys(const Measurement& measured, double truth, double allowance = 0);

// A test with the name of a backend as parameter, skipped where the backend cannot be used.
class OnEachBackend : public testing::TestWithParam<std::string> {
protected:
    void SetUp() override;
    // `rounds` on cpu, a third of them on the slower backends.
    Measurement measure(diptych::SceneData scene, int rounds = 1);

    std::unique_ptr<diptych::Backend> backend_;
};

#define ON_EACH_BACKEND(suite)                                                                \
    INSTANTIATE_TEST_SUITE_P(Laws, suite, testing::Values("cpu", "twin", "double", "opencl"), \
                             [](const auto& info) { return info.param; })

// A material without specular reflection, as most laws want it.
diptych::MaterialInput lambert(float reflectance, float emission = 0);

// A box seen from within: its six sides face inwards.
std::vector<diptych::MeshPart> room(const diptych::Vec3& low, const diptych::Vec3& high,
                                    int material);

// A regular polygon of as much area as the disc of that radius, facing `normal`.
diptych::MeshPart disc(const diptych::Vec3& centre, const diptych::Vec3& normal, double radius,
                       int material, int corners = 256);

// A sphere of flat triangles; facing inwards or outwards.
diptych::MeshPart faceted_sphere(double radius, int segments, int material, bool is_inward);
double area(const diptych::MeshPart& part);

// An environment of radiance(direction).
diptych::Picture environment_of(const std::function<double(const diptych::Vec3&)>& radiance,
                                int width = 4, int height = 2);

// A picture of 16 x 16 pixels, box filter, orthographic, of a square of this half height around
// `target`.
void look(diptych::SceneBuilder& scene, const diptych::Vec3& eye, const diptych::Vec3& target,
          double half_height);
diptych::SceneData finish(diptych::SceneBuilder& scene, int bounces = BOUNCES_UNLIMITED);

// Something of everything: textures, normal map, instances, alpha, lamps, a spot, sky.
diptych::SceneData busy_scene(int width, int height);

}  // namespace laws
