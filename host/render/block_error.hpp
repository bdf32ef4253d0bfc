// The predicted error of a film, from the spread of its batches.
#pragma once

#include "host/image/visible_error.hpp"
#include "host/render/film.hpp"
#include "host/render/scheduler.hpp"

namespace diptych {

// Standard errors that an error stays below with 95 % probability: Student's factor for 20 degrees
// of freedom. Eight batches of nine pixels would have 63, were the pixels alike.
inline constexpr float confidence = 2.09f;

// JND: the standard error of a pixel of which nothing is known, as large as any can be: from black
// to white.
inline constexpr float unknown_error = 50;

// One standard error of a pixel of the film, in JND.
float pixel_error(const Film& film, int x, int y, const image::Viewer& viewer);

// What a pixel's error stays below with 95 % probability, in JND: from its own batches and those of
// its neighbours, 3 x 3 pixels.
float pixel_bound(const Film& film, int x, int y, const image::Viewer& viewer);

// Of `confidence` standard errors of a block's pixels. Nothing outside of it counts: neighbours may
// be under way.
BlockError block_error(const Film& film, const image::Viewer& viewer, Pixel corner, int shift);
// Of each block.
std::vector<BlockError> block_errors(const Film& film, const BlockGrid& grid,
                                     const image::Viewer& viewer);
// 95 % of the blocks have less, in JND: error_of, by which blocks are done.
double block_p95(std::vector<BlockError> errors);

// The same, of the blocks that are not done of the team whose turn it is, into their states.
void measure_team(Schedule& schedule, const Film& film, const BlockGrid& grid,
                  const image::Viewer& viewer);

// What the film's error is expected to be.
struct ErrorSummary {
    int blocks = 0;
    double rms = 0;            // JND, one standard error
    double block_p95 = 0;      // JND; 95 % of the blocks predict less, at 95 % confidence
    double share_within = 1;   // of the pixels, expected to be nearer to the truth than the target
    double share_unknown = 0;  // of the pixels: too few samples to tell
};
ErrorSummary summarise_error(const Film& film, const BlockGrid& grid, const image::Viewer& viewer,
                             double target);

// The layer predicted_error: of each pixel of the picture, the error in JND that it stays below
// with 95 % probability. Its own batches and those of its neighbours tell, 3 x 3 pixels.
std::vector<float> predicted_error(const Film& film, const image::Viewer& viewer);

// The film's layers, predicted_error among them where it is known.
image::Picture picture_of(const Film& film, const image::Viewer& viewer);

}  // namespace diptych
