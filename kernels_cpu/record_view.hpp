// Views of the paths in which their records stand where textures are asked.
#pragma once

#include "common/as_cpp/texture_lookups.hpp"
#include "kernels_cpu/kernels.hpp"

#include <algorithm>
#include <vector>

namespace diptych {

class RecordViews {
public:
    RecordViews() = default;
    // `paths` has its planes already.
    explicit RecordViews(const PathView& paths)
        : of_path_(paths.planes, paths.planes + path_row_count), of_shadow_(of_path_)
    {
        for (const StandIn& record : path_records) put(paths, record, of_path_);
        for (const StandIn& record : shadow_records) put(paths, record, of_shadow_);
    }

    // Runs a stage of the rows with the lookups that belong to it: run(stage, view) over the first
    // `count` paths. As run_with_lookups.
    template<typename Run>
    int run(Stage stage, unsigned effects, const PathView& paths, int count, const Run& run) const
    {
        const auto launch = [&](Stage launched, int lookup) {
            PathView view = paths;
            view.lookup = lookup;
            if (is_over_records(launched, lookup))
                view.planes =
                    LOOKUP_PLACE(lookup) == LOOKUP_ALPHA ? of_path_.data() : of_shadow_.data();
            run(launched, view);
        };
        const auto waiting = [&] {
            const int* record = static_cast<const int*>(paths.texture_planes[row_record_triangle]);
            return int(std::count_if(record, record + count, [](int r) { return r >= 0; }));
        };
        return run_with_lookups(stage, effects, launch, waiting);
    }

private:
    static void put(const PathView& paths, const StandIn& record, std::vector<void*>& planes)
    {
        planes[size_t(record.row)] =
            record.is_texture_row ? paths.texture_planes[record.by] : paths.planes[record.by];
    }

    std::vector<void*> of_path_;
    std::vector<void*> of_shadow_;
};

}  // namespace diptych
