// The times of the textures' study: rows of a table, each a material of the helmet and a way to run
// its textures, that take turns on one backend.
#pragma once

#include "backends/backend.hpp"
#include "backends/textures/texture_arms.hpp"
#include "host/commands/study_scene.hpp"
#include "host/image/image.hpp"

#include <functional>
#include <string>
#include <vector>

namespace diptych {

struct StudyRow {
    std::string name;
    HelmetMaterial material = HelmetMaterial::plain;
    TextureArm arm{};
};

struct RowTimes {
    double seconds = 0;          // of wall clock, all dispatches together
    double stage_seconds = 0;    // of all stages, summed over threads
    double ray_seconds = 0;      // of trace_texture_rays
    double texture_seconds = 0;  // of evaluate_textures
    double setup_seconds = 0;    // structures and programs
    size_t differing = 0;  // results that are not bit for bit those of the material's first row
};

struct BackendTimes {
    std::string description;
    std::vector<RowTimes> rows;
    std::vector<image::Picture> pictures;  // of the rows
    double samples = 0;                    // of a row, all pixels together
};

// Renders all rows, dispatch by dispatch in turns, so that what else the machine does hits all
// alike. Of `repetitions` of each dispatch the least time counts.
BackendTimes measure_rows(const std::string& backend, const BackendOptions& options,
                          const StudyScenes& scenes, const StudyOptions& study,
                          const std::vector<StudyRow>& rows, int repetitions);

}  // namespace diptych
