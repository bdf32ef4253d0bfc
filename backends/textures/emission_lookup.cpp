#include "backends/textures/emission_lookup.hpp"

#include "backends/scene_view.hpp"
#include "backends/textures/native_stage.hpp"
#include "common/as_cpp/path_rows.hpp"
#include "common/as_cpp/texture_rows.hpp"

#include <algorithm>

namespace diptych {
namespace {

// The planes that the texture stage reads and writes, a query for each path.
class QueryPaths {
public:
    QueryPaths(const SceneData& scene, const std::vector<EmissionQuery>& queries)
        : count_(queries.size()), planes_(path_row_count), texture_planes_(texture_rows)
    {
        for (int row = 0; row < path_row_count; ++row)
            planes_[size_t(row)] = add(path_rows[row].components, 0.0f);
        const std::array<int, texture_rows> planes = texture_planes(scene);
        for (int row = 0; row < texture_rows; ++row)
            texture_planes_[size_t(row)] = add(planes[size_t(row)], 1.0f);
        for (const int faults : texture_result_planes(scene))  // counted, and not looked at
            texture_result_planes_.push_back(add(faults, 0.0f));
        for (size_t k = 0; k < count_; ++k) {
            static_cast<int*>(planes_[row_hit_triangle])[k] = queries[k].triangle;
            static_cast<int*>(planes_[row_hit_instance])[k] = queries[k].instance;
            set3(row_ray_origin, k, queries[k].origin);
            set3(row_ray_direction, k, queries[k].direction);
        }
        view_.capacity = int(count_);
        view_.results = 1;
        view_.items = &item_;
        view_.texture_result_planes = texture_result_planes_.data();
        view_.lookup = LOOKUP_EMISSION;
        view_.planes = planes_.data();
        view_.texture_planes = texture_planes_.data();
    }

    const PathView& view() const { return view_; }
    float result(int plane, size_t k) const
    {
        return static_cast<const float*>(
            texture_planes_[row_texture_result])[size_t(plane) * count_ + k];
    }

private:
    void* add(int planes, float value)
    {
        memory_.emplace_back(size_t(planes) * count_ + 16, value);
        return memory_.back().data();
    }
    void set3(PathRowName row, size_t k, float3 v)
    {
        float* plane = static_cast<float*>(planes_[row]);
        plane[k] = v.x;
        plane[count_ + k] = v.y;
        plane[2 * count_ + k] = v.z;
    }

    size_t count_;
    std::vector<std::vector<float>> memory_;
    std::vector<void*> planes_;
    std::vector<void*> texture_planes_;
    std::vector<void*> texture_result_planes_;
    WorkItem item_{};
    PathView view_;
};

}  // namespace

std::vector<float4> look_up_emission(const SceneData& scene,
                                     const std::vector<EmissionQuery>& queries)
{
    NativeStageOptions options;
    options.kind = NativeStageKind::silent;
    const NativeStage stage(scene, options);
    const std::vector<const void*> buffers = buffers_of(scene);
    SceneView view;
    view.effects = scene.effects;
    view.buffers = buffers.data();
    const QueryPaths paths(scene, queries);
    stage.kernels().evaluate(view, paths.view(), 0, int(queries.size()));
    const int output = scene.settings.at(0).texture_output[SLOT_EMISSION];
    const int plane = 4 * std::max(output, 0);
    std::vector<float4> values;
    for (size_t k = 0; k < queries.size(); ++k)
        values.push_back({paths.result(plane, k), paths.result(plane + 1, k),
                          paths.result(plane + 2, k), paths.result(plane + 3, k)});
    return values;
}

}  // namespace diptych
