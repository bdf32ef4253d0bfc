// GI-19: how much a stopping rule takes from pixels whose light comes in rare spikes.
#pragma once

namespace spikes {

// Every sample is `base`, and with probability p `spike` more.
struct Pixel {
    float base = 0.15f;
    float spike = 60;
    double p = 0.0005;

    double mean() const { return double(base) + double(spike) * p; }
};

struct Outcome {
    double mean = 0;     // of the picture
    double samples = 0;  // a pixel's, on average
};

// A picture of such pixels, rendered until its predicted error is 1 JND, however long that takes.
Outcome render_to_error(const Pixel& pixel, unsigned seed, bool is_unbiased = false);

// The same by the rule that is common: each pixel ends when two halves of its samples agree, and
// its eight neighbours' do (Cycles at its default threshold 0.01, at least 64 samples, every 16).
Outcome render_by_pixels(const Pixel& pixel, unsigned seed);

}  // namespace spikes
