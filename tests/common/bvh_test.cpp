// The walk of common/bvh.h against Embree, and its own laws: ties, order, depth, odd input.
#include "tests/common/bvh_fixture.hpp"

#include "backends/bvh_flatten.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

using namespace diptych;

namespace {

// Rays of which Embree and the walk may name different triangles: those that meet an edge, or two
// triangles at nearly the same distance.
void expect_embree_agrees(const SceneData& scene, const std::vector<TestRay>& rays,
                          double tolerance)
{
    const EmbreeScene embree(scene);
    const Scene view = view_of(scene);
    int disagree = 0;
    int hits = 0;
    for (const TestRay& ray : rays) {
        const Hit ours = bvh_closest(&view, ray.origin, ray.direction, FLOAT_MAX, 0);
        const Hit theirs = embree.closest(ray);
        hits += ours.triangle >= 0;
        const bool is_close = std::abs(ours.t - theirs.t) <= tolerance * (1 + std::abs(theirs.t));
        const bool is_same =
            (ours.triangle < 0) == (theirs.triangle < 0) && (ours.triangle < 0 || is_close);
        disagree += !is_same;
        EXPECT_EQ(bvh_occluded(&view, ray.origin, ray.direction, FLOAT_MAX, 0), ours.triangle >= 0);
    }
    EXPECT_GT(hits, int(rays.size()) / 20) << "the rays test little";
    EXPECT_LE(disagree, int(rays.size()) / 10000);
}

TEST(Bvh, AgreesWithEmbreeOnRandomTriangles)
{
    SceneData scene = soup(20000, 0.05f, 0.0f);
    build_bvh(scene);
    expect_embree_agrees(scene, random_rays(30000, 0.0f, 1), 1e-4);
}

TEST(Bvh, AgreesWithEmbreeFarFromTheOrigin)
{
    SceneData scene = soup(5000, 0.5f, 1e5f);
    build_bvh(scene);
    expect_embree_agrees(scene, random_rays(20000, 1e5f, 2), 1e-1);
}

TEST(Bvh, AgreesWithEmbreeOnAxisAlignedRaysAndWalls)
{
    SceneData scene = boxes(200);
    build_bvh(scene);
    expect_embree_agrees(scene, axis_rays(20000, 3), 1e-4);
    expect_embree_agrees(scene, random_rays(20000, 0.0f, 4), 1e-4);
}

TEST(Bvh, AgreesWithEmbreeOnInstances)
{
    SceneData scene = soup(300, 0.3f, 0.0f);
    add_instances(scene, 200);
    build_bvh(scene);
    expect_embree_agrees(scene, random_rays(20000, 0.0f, 5), 1e-4);
}

// Rays that skim a wavy sheet; the exact answer comes from testing every triangle.
TEST(Bvh, LosesNoHitThatATriangleTestFinds)
{
    for (const float size : {1e-3f, 1.0f, 1e4f}) {
        SceneData scene = sheet(24, size);
        build_bvh(scene);
        const Scene view = view_of(scene);
        int hits = 0;
        for (const TestRay& ray : grazing_rays(3000, size, 6)) {
            const Hit ours = bvh_closest(&view, ray.origin, ray.direction, FLOAT_MAX, 0);
            const Hit all = closest_of_all(scene, ray);
            ASSERT_EQ(ours.triangle, all.triangle);
            ASSERT_EQ(ours.t, all.t);
            hits += all.triangle >= 0;
        }
        EXPECT_GT(hits, 500);
    }
}

// Rays into the edges and corners of a closed box, where boxes of the tree are flat: none escapes.
TEST(Bvh, KeepsRaysInsideAClosedBox)
{
    SceneData scene = boxes(1);
    build_bvh(scene);
    const Scene view = view_of(scene);
    int leaks = 0;
    for (const TestRay& ray : edge_rays(scene, 100000, 7))
        leaks += bvh_closest(&view, ray.origin, ray.direction, FLOAT_MAX, 0).triangle < 0;
    EXPECT_EQ(leaks, 0);
}

TEST(Bvh, DecidesTiesByTheSmallestTriangleAndInstance)
{
    SceneData scene = soup(64, 0.5f, 0.0f);
    const std::vector<Triangle> once = scene.triangles;
    for (int copy = 0; copy < 3; ++copy)
        scene.triangles.insert(scene.triangles.end(), once.begin(), once.end());
    scene.instances[0].triangle_count = int(scene.triangles.size());
    scene.instances.push_back(scene.instances[0]);
    scene.effects |= EFFECT_INSTANCES;
    build_bvh(scene);
    const Scene view = view_of(scene);
    int hits = 0;
    for (const TestRay& ray : random_rays(2000, 0.0f, 8)) {
        const Hit hit = bvh_closest(&view, ray.origin, ray.direction, FLOAT_MAX, 0);
        if (hit.triangle < 0) continue;
        ++hits;
        EXPECT_LT(hit.triangle, 64);
        EXPECT_EQ(hit.instance, 0);
    }
    EXPECT_GT(hits, 100);
}

TEST(Bvh, StopsAtTheGivenDistance)
{
    SceneData scene = boxes(1);
    build_bvh(scene);
    const Scene view = view_of(scene);
    const float3 centre = box_centre(scene);
    const Hit hit = bvh_closest(&view, centre, {0, 0, 1}, FLOAT_MAX, 0);
    ASSERT_GE(hit.triangle, 0);
    EXPECT_TRUE(bvh_occluded(&view, centre, {0, 0, 1}, hit.t, 0));
    EXPECT_FALSE(bvh_occluded(&view, centre, {0, 0, 1}, hit.t * 0.999f, 0));
    EXPECT_LT(bvh_closest(&view, centre, {0, 0, 1}, hit.t * 0.999f, 0).triangle, 0);
}

TEST(Bvh, AnswersForNothingAndForOneTriangle)
{
    SceneData nothing;
    build_bvh(nothing);
    const Scene empty = view_of(nothing);
    EXPECT_LT(bvh_closest(&empty, {0, 0, 0}, {0, 0, 1}, FLOAT_MAX, 0).triangle, 0);
    SceneData scene = soup(1, 1.0f, 0.0f);
    build_bvh(scene);
    int hits = 0;
    const Scene view = view_of(scene);
    for (const TestRay& ray : random_rays(2000, 0.0f, 9)) {
        const Hit all = closest_of_all(scene, ray);
        ASSERT_EQ(bvh_closest(&view, ray.origin, ray.direction, FLOAT_MAX, 0).triangle,
                  all.triangle);
        hits += all.triangle >= 0;
    }
    EXPECT_GT(hits, 10);
}

// A ray of numbers that are none ends, with a miss.
TEST(Bvh, EndsOnRaysThatAreNone)
{
    SceneData scene = soup(1000, 0.2f, 0.0f);
    build_bvh(scene);
    const Scene view = view_of(scene);
    EXPECT_LT(bvh_closest(&view, {NAN, 0, 0}, {0, 0, 1}, FLOAT_MAX, 0).triangle, 0);
    EXPECT_LT(bvh_closest(&view, {0, 0, 0}, {NAN, NAN, NAN}, FLOAT_MAX, 0).triangle, 0);
    EXPECT_LT(bvh_closest(&view, {INFINITY, 0, 0}, {0, 0, 1}, FLOAT_MAX, 0).triangle, 0);
}

TEST(BvhBuild, NamesEveryTriangleOnceAndKeepsTheDepth)
{
    for (SceneData scene : {soup(50000, 0.02f, 0.0f), pile(4000), spiral(3000)}) {
        build_bvh(scene);
        EXPECT_EQ(std::set<int>(scene.bvh_items.begin(), scene.bvh_items.end()).size(),
                  scene.triangles.size());
        EXPECT_EQ(scene.bvh_items.size(), scene.triangles.size());
        EXPECT_LE(depth_of(scene, scene.instances[0].root_node), BVH_MESH_DEPTH);
    }
}

// With hardly more levels than halves need, deep parts are split anew; hits stay the same.
TEST(BvhBuild, HalvesWhatWouldLieTooDeep)
{
    for (const int depth : {10, 11, 14}) {
        SceneData scene = spiral(3000);
        std::vector<BuildItem> items;
        for (int id = 0; id < 3000; ++id) items.push_back({triangle_box(scene, id), id});
        BvhBuilder builder;
        BvhFlattener flattener(scene.bvh_nodes, scene.bvh_items);
        const BuildTree tree = builder.build(items, BVH_MESH_LEAF);
        scene.instances[0].root_node = flattener.add(tree, depth);
        EXPECT_LE(depth_of(scene, scene.instances[0].root_node), depth);
        EXPECT_EQ(std::set<int>(scene.bvh_items.begin(), scene.bvh_items.end()).size(), 3000u);

        SceneData usual = spiral(3000);
        build_bvh(usual);
        EXPECT_GT(depth_of(usual, usual.instances[0].root_node), depth) << "the test tests little";
        const Scene view = view_of(scene);
        const Scene usual_view = view_of(usual);
        for (const TestRay& ray : random_rays(1000, 0.0f, 10)) {
            const Hit a = bvh_closest(&view, ray.origin, ray.direction, FLOAT_MAX, 0);
            const Hit b = bvh_closest(&usual_view, ray.origin, ray.direction, FLOAT_MAX, 0);
            EXPECT_EQ(a.triangle, b.triangle);
        }
    }
}

TEST(BvhBuild, SharesTheTreeOfAMeshAmongItsInstances)
{
    SceneData scene = soup(300, 0.3f, 0.0f);
    add_instances(scene, 50);
    build_bvh(scene);
    for (size_t k = 2; k < scene.instances.size(); ++k)
        EXPECT_EQ(scene.instances[k].root_node, scene.instances[1].root_node);
    EXPECT_EQ(scene.bvh_items.size(), 300u + 50u);
}

TEST(BvhBuild, GivesTheSameTreeAgain)
{
    SceneData one = soup(30000, 0.02f, 0.0f);
    SceneData two = one;
    build_bvh(one);
    build_bvh(two);
    EXPECT_EQ(one.bvh_items, two.bvh_items);
    ASSERT_EQ(one.bvh_nodes.size(), two.bvh_nodes.size());
    EXPECT_EQ(std::memcmp(one.bvh_nodes.data(), two.bvh_nodes.data(),
                          one.bvh_nodes.size() * sizeof(BvhNode)),
              0);
}

}  // namespace
