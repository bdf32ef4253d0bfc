#include "tests/laws/measure.hpp"

#include "host/render/render.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace laws {

using namespace diptych;

double Measurement::mean() const
{
    double sum = 0;
    for (const double batch : of_batch) sum += batch;
    return sum / batches;
}

double Measurement::sigma() const
{
    double square = 0;
    for (const double batch : of_batch) square += (batch - mean()) * (batch - mean());
    return std::sqrt(square / (batches - 1) / batches);
}

Measurement difference(const Measurement& a, const Measurement& b)
{
    Measurement result = a;
    for (size_t k = 0; k < a.pixels.size(); ++k) result.pixels[k] -= b.pixels[k];
    for (size_t k = 0; k < batches; ++k) result.of_batch[k] -= b.of_batch[k];
    result.faults += b.faults;
    return result;
}

namespace {

// x or y of an entry of a block: every second bit of its Morton code.
int even_bits(int code)
{
    int bits = 0;
    for (int k = 0; k < BLOCK_SHIFT; ++k) bits |= (code >> (2 * k) & 1) << k;
    return bits;
}

}  // namespace

Measurement measure(Backend& backend, SceneData& scene, int rounds)
{
    const int width = scene.settings[0].width, height = scene.settings[0].height;
    const double pixels = double(width) * height;
    Measurement measured;
    measured.pixels.assign(size_t(width) * size_t(height), 0.0);
    backend.upload(scene);
    std::vector<WorkItem> items;
    Results results;
    for (int quantum = 0; quantum < rounds * batches; ++quantum) {
        items.clear();
        for (const Pixel& block : blocks_of(width, height))
            items.push_back({block.x, block.y, quantum * QUANTUM, 0});
        const Dispatch dispatch{items};
        backend.render(dispatch, results);
        const size_t green = size_t(dispatch.results());
        for (size_t r = 0; r < green; ++r) {
            const WorkItem& item = items[r >> dispatch.pixel_shift];
            const int x = item.x + even_bits(int(r)), y = item.y + even_bits(int(r) >> 1);
            if (x >= width || y >= height) continue;
            const double mean = double(results.sum_radiance[green + r]) / QUANTUM;
            measured.pixels[size_t(y * width + x)] += mean / (rounds * batches);
            measured.of_batch[size_t(quantum % batches)] += mean / (rounds * pixels);
            measured.faults += unsigned(results.fault[r]);
        }
    }
    return measured;
}

testing::AssertionResult obeys(const Measurement& measured, double truth, double allowance)
{
    const double error = measured.mean() - truth, sigma = measured.sigma();
    const bool is_right = std::abs(error) <= 4 * sigma + (0.001 + allowance) * truth;
    const bool is_sharp = sigma <= 0.01 * truth;
    const bool is_clean = measured.faults == 0;
    return (is_right && is_sharp && is_clean ? testing::AssertionSuccess()
                                             : testing::AssertionFailure())
           << "measured " << measured.mean() << " +- " << sigma << ", truth " << truth << " ("
           << 100 * error / truth << " %, " << error / sigma << " sigma), " << measured.faults
           << " samples not finite";
}

void OnEachBackend::SetUp()
{
    try {
        backend_ = make_backend(GetParam(), {});
    } catch (const std::runtime_error& error) {
        GTEST_SKIP() << error.what();
    }
}

Measurement OnEachBackend::measure(SceneData scene, int rounds)
{
    const int share = GetParam() == "cpu" ? rounds : std::max(1, rounds / 3);
    return laws::measure(*backend_, scene, share);
}

MaterialInput lambert(float reflectance, float emission)
{
    return {.base_color = {reflectance, reflectance, reflectance, 1},
            .specular = 0,
            .emission = {emission, emission, emission}};
}

std::vector<MeshPart> room(const Vec3& low, const Vec3& high, int material)
{
    const Vec3 x{high[0] - low[0], 0, 0}, y{0, high[1] - low[1], 0}, z{0, 0, high[2] - low[2]};
    return {quad_mesh(low, x, y, material),
            quad_mesh(low, y, z, material),
            quad_mesh(low, z, x, material),
            quad_mesh(high, y * -1, x * -1, material),
            quad_mesh(high, z * -1, y * -1, material),
            quad_mesh(high, x * -1, z * -1, material)};
}

MeshPart disc(const Vec3& centre, const Vec3& normal, double radius, int material, int corners)
{
    using std::numbers::pi;
    const Vec3 n = unit(normal);
    const Vec3 u = unit(cross(n, std::abs(n[0]) < 0.5 ? Vec3{1, 0, 0} : Vec3{0, 1, 0}));
    const Vec3 v = cross(n, u);
    const double angle = 2 * pi / corners;
    const double size = radius * std::sqrt(angle / std::sin(angle));
    MeshPart part;
    part.material = material;
    part.positions.push_back({float(centre[0]), float(centre[1]), float(centre[2])});
    for (int k = 0; k < corners; ++k) {
        const Vec3 p = centre + u * (size * std::cos(angle * k)) + v * (size * std::sin(angle * k));
        part.positions.push_back({float(p[0]), float(p[1]), float(p[2])});
        part.indices.insert(part.indices.end(), {0, uint(k) + 1, uint((k + 1) % corners) + 1});
    }
    return part;
}

MeshPart faceted_sphere(double radius, int segments, int material, bool is_inward)
{
    MeshPart part = sphere_mesh({0, 0, 0}, radius, segments, material);
    part.normals.clear();
    part.uvs.clear();
    for (size_t k = 0; is_inward && k < part.indices.size(); k += 3)
        std::swap(part.indices[k], part.indices[k + 1]);
    return part;
}

double area(const MeshPart& part)
{
    const auto corner = [&](size_t k) {
        const float3 p = part.positions[part.indices[k]];
        return Vec3{p.x, p.y, p.z};
    };
    double sum = 0;
    for (size_t k = 0; k < part.indices.size(); k += 3)
        sum += length(cross(corner(k + 1) - corner(k), corner(k + 2) - corner(k))) / 2;
    return sum;
}

Picture environment_of(const std::function<double(const Vec3&)>& radiance, int width, int height)
{
    using std::numbers::pi;
    Picture map{width, height, {}, {}, false, 0};
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const double around = 2 * pi * ((x + 0.5) / width - 0.5),
                         down = pi * (y + 0.5) / height;
            const float value = float(radiance({std::cos(around) * std::sin(down), std::cos(down),
                                                std::sin(around) * std::sin(down)}));
            map.floats.insert(map.floats.end(), {value, value, value, 1});
        }
    }
    return map;
}

void look(SceneBuilder& scene, const Vec3& eye, const Vec3& target, double half_height)
{
    scene.set_camera({.eye = eye, .target = target, .half_height = half_height});
    scene.set_picture_size(16, 16);
}

SceneData finish(SceneBuilder& scene, int bounces)
{
    SceneData data = scene.finish();
    data.settings[0].max_bounces = bounces;
    data.settings[0].filter = FILTER_BOX;
    data.settings[0].seed = 7;
    return data;
}

SceneData busy_scene(int width, int height)
{
    SceneBuilder scene;
    Picture checks{4, 4, {}, {}, true, 0};
    for (int k = 0; k < 16; ++k) {
        const std::uint8_t value = (k + k / 4) % 2 ? 220 : 60;
        checks.bytes.insert(checks.bytes.end(), {value, 128, value, std::uint8_t(k * 16)});
    }
    const int image = scene.add_image(checks);
    const int floor = scene.add_material({.roughness = 0.4f, .base_texture = {.image = image}});
    const int leaf = scene.add_material(
        {.specular = 0, .alpha_mode = ALPHA_BLEND, .base_texture = {.image = image}});
    const int metal =
        scene.add_material({.metallic = 1, .roughness = 0.2f, .normal_texture = {.image = image}});
    const int lamp = scene.add_material({.emission = {5, 4, 3}});
    scene.place(scene.add_mesh(quad_mesh({-2, 0, -2}, {0, 0, 4}, {4, 0, 0}, floor)));
    scene.place(scene.add_mesh(quad_mesh({-1, 0.1, 0.6}, {1, 0, 0}, {0, 1, 0}, leaf)));
    scene.place(scene.add_mesh(quad_mesh({-0.5, 2, -0.5}, {1, 0, 0}, {0, 0, 1}, lamp)));
    const int ball = scene.add_mesh(sphere_mesh({0, 0, 0}, 0.3, 24, metal));
    for (int k = 0; k < 4; ++k) scene.place(ball, translation(0.7 * k - 1, 0.3, -0.2 * k));
    scene.add_light({.kind = LIGHT_SPOT,
                     .intensity = {4, 4, 4},
                     .position = {1, 2, 1},
                     .direction = {-0.5, -1, -0.5}});
    scene.set_environment(environment_of([](const Vec3& w) { return 0.3 + 0.2 * w[1]; }, 8, 8));
    scene.set_camera({.eye = {0.5, 1.2, 3}, .target = {0, 0.4, 0}});
    scene.set_picture_size(width, height);
    SceneData data = scene.finish();
    data.settings[0].max_bounces = 6;
    return data;
}

}  // namespace laws
