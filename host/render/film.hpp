// The picture in progress, on the host: sums of what work items brought.
#pragma once

#include "backends/backend.hpp"
#include "host/image/image.hpp"
#include "host/render/texture_faults.hpp"

#include <array>

namespace diptych {

// Batches from whose means the standard error is taken: those of common/random.h.
inline constexpr int batch_count = 8;
// Below this many samples some batch has less than a quantum, and there is no standard error.
inline constexpr int standard_error_samples = batch_count * QUANTUM;

// Samples that were not finite: dropped, and the first of them in the order of rendering.
struct Faults {
    unsigned long long count = 0;
    int x = -1;
    int y = -1;
    int first_sample = -1;
};

// A rectangle of the picture.
struct Window {
    int x = 0;
    int y = 0;
    int width = 0;
    int height = 0;

    size_t pixels() const { return size_t(width) * size_t(height); }
};

// Everything that a film remembers: with it a render can be continued. `pixel` counts through the
// window, row by row. Sums are double, so that films of different samples add up to the same bits
// in any order (short of quanta that differ in brightness by a factor of millions).
struct FilmData {
    Window window;
    int batches = 1;
    std::vector<double> radiance;    // [pixel][batch][3]
    std::vector<int> batch_samples;  // [pixel][batch]
    std::vector<float> alpha;        // summed over all samples, as the next three
    std::vector<double> albedo, normal, distance;
    std::vector<int> object, material;  // met by the very first sample; -1: nothing, not rendered
    Faults faults;
    TextureFaults texture_faults;
    std::vector<TextureAov> aovs;
    std::vector<double> aov_values;  // [pixel][aov][4], summed
};

// How many batches the samples 0 to end - 1 fall into, where they are told apart: not in sequences
// longer than a quantum.
int batches_of(int end, int sequence_quanta);

// Settings::sequence_quanta of a uniform render of so many samples a pixel: below
// standard_error_samples, and where it is not asked for an error, one sequence holds all samples,
// or the first of several that are as long as sequences can be.
int sequence_quanta_of(int samples, bool is_error_wanted);

class Film {
public:
    // Keeps only what lies in the window. batches: batches_of the last sample's number plus one.
    // aovs: texture nodes that have a layer each.
    Film(int width, int height, const Window& window, int batches,
         std::vector<TextureAov> aovs = {});

    static size_t bytes(const Window& window, int batches, size_t aovs = 0);

    void add(const Dispatch& dispatch, const Results& results);

    int width() const { return width_; }  // of the picture
    int height() const { return height_; }
    const Faults& faults() const { return data_.faults; }
    const TextureFaults& texture_faults() const { return data_.texture_faults; }
    const FilmData& data() const { return data_; }
    FilmData& data() { return data_; }

    // Mean radiance of a pixel of the picture; black outside the window and without samples.
    std::array<float, 3> radiance(int x, int y) const;

    // Standard error of that mean, from the spread of the batches; 0 with fewer than two, which
    // know nothing of it.
    std::array<float, 3> standard_error(int x, int y) const;
    bool is_error_known(int x, int y) const;
    std::array<float, 3> albedo(int x, int y) const;  // mean

    // R, G, B and coverage of every pixel of the picture.
    std::vector<float> beauty() const;

    // Starts the sums anew; what the first samples met is kept.
    void forget_samples();

    // Beauty (alpha = coverage), albedo, normal, depth, object and material id, sample count, with
    // batches standard error, and the texture nodes. Pixels without samples are black.
    image::Picture picture() const;
    // What the values of such a picture take, of so many pixels.
    static size_t picture_bytes(size_t pixels, int batches, size_t aovs = 0);
    bool has_standard_error() const { return data_.batches == batch_count; }

private:
    // False when the radiance summed up on the device is not finite; it is left out then.
    bool add_pixel(size_t pixel, const WorkItem& item, const Dispatch& dispatch,
                   const Results& results, int r);
    size_t pixel_at(int x, int y) const;
    int samples_of(size_t pixel) const;
    std::array<float, 3> mean_of(size_t pixel) const;
    std::array<float, 3> standard_error_of(size_t pixel) const;
    std::vector<float> means(const std::vector<double>& sums, size_t channels) const;
    std::vector<float> aov_means(size_t aov) const;

    int width_;
    int height_;
    FilmData data_;
};

}  // namespace diptych
