// The picture in progress, on the host: sums of what work items brought.
#pragma once

#include "backends/backend.hpp"
#include "host/image/image.hpp"

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

class Film {
public:
    // samples: a pixel's in the whole render; decides whether batches are kept apart.
    Film(int width, int height, int samples);

    static size_t bytes(int width, int height, int samples);

    void add(const Dispatch& dispatch, const Results& results);

    int width() const { return width_; }
    int height() const { return height_; }
    const Faults& faults() const { return faults_; }

    // Beauty (alpha = coverage), albedo, normal, depth, object and material id, sample count and,
    // from standard_error_samples on, standard error. Pixels without samples are black.
    image::Picture picture() const;
    bool has_standard_error() const { return batches_ == batch_count; }

private:
    // False when the radiance would make the sum overflow; it is left out then.
    bool add_pixel(int pixel, int batch, const Dispatch& dispatch, const Results& results, int r);
    std::vector<float> standard_error() const;
    std::vector<float> means(const std::vector<float>& sums, int channels) const;

    int width_;
    int height_;
    int batches_;
    std::vector<float> radiance_;     // [pixel][batch][3]: each batch sums its quanta in order
    std::vector<int> batch_samples_;  // [pixel][batch]
    std::vector<float> alpha_, albedo_, normal_, distance_;  // summed over all samples
    std::vector<int> object_, material_;
    Faults faults_;
};

}  // namespace diptych
