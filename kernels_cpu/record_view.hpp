// A view of the paths in which their records stand where textures are asked.
#pragma once

#include "common/as_cpp/texture_lookups.hpp"
#include "kernels_cpu/kernels.hpp"

#include <span>
#include <vector>

namespace diptych {

class RecordView {
public:
    RecordView() = default;
    // `paths` has its planes already.
    RecordView(const PathView& paths, std::span<const StandIn> records)
        : planes_(paths.planes, paths.planes + path_row_count)
    {
        for (const StandIn& record : records)
            planes_[size_t(record.row)] =
                record.is_texture_row ? paths.texture_planes[record.by] : paths.planes[record.by];
    }

    // The planes of the records, everything else as `paths` says now.
    PathView of(const PathView& paths, int lookup) const
    {
        PathView view = paths;
        view.planes = planes_.data();
        view.lookup = lookup;
        return view;
    }

private:
    std::vector<void*> planes_;
};

}  // namespace diptych
