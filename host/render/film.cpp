#include "host/render/film.hpp"

#include <algorithm>
#include <cmath>

namespace diptych {
namespace {

// log2: 4096 samples, so that pixels share no part of a sequence with any nearer than 1024.
constexpr int most_sequence_quanta = 8;

// x or y of entry k of a work item: the even bits of its Morton code.
int even_bits(int k)
{
    int out = 0;
    for (int bit = 0; bit < BLOCK_SHIFT; ++bit) out |= (k >> (2 * bit) & 1) << bit;
    return out;
}

bool contains(const Window& window, int x, int y)
{
    return x >= window.x && y >= window.y && x < window.x + window.width &&
           y < window.y + window.height;
}

// A layer of the whole picture from one of the window: zero outside.
template<class Value>
std::vector<Value> padded(std::vector<Value> in, const Window& window, int width, int height)
{
    const size_t channels = in.size() / window.pixels();
    if (window.width == width && window.height == height) return in;
    std::vector<Value> out(size_t(width) * size_t(height) * channels);
    const size_t row = size_t(window.width) * channels;
    for (int y = 0; y < window.height; ++y)
        std::copy_n(in.begin() + std::ptrdiff_t(size_t(y) * row), row,
                    out.begin() +
                        std::ptrdiff_t((size_t(window.y + y) * size_t(width) + size_t(window.x)) *
                                       channels));
    return out;
}

}  // namespace

int batches_of(int end, int sequence_quanta)
{
    return sequence_quanta > 0 ? 1 : std::clamp((end + QUANTUM - 1) / QUANTUM, 1, batch_count);
}

int sequence_quanta_of(int samples, bool is_error_wanted)
{
    int quanta = 0;
    if (samples < standard_error_samples || !is_error_wanted)
        while (quanta < most_sequence_quanta && (QUANTUM << quanta) < samples) ++quanta;
    return quanta;
}

Film::Film(int width, int height, const Window& window, int batches, std::vector<TextureAov> aovs)
    : width_(width), height_(height)
{
    data_.window = window;
    data_.batches = batches;
    const size_t pixels = window.pixels();
    data_.radiance.assign(pixels * size_t(batches) * 3, 0.0);
    data_.batch_samples.assign(pixels * size_t(batches), 0);
    data_.alpha.assign(pixels, 0.0f);
    data_.albedo.assign(pixels * 3, 0.0);
    data_.normal.assign(pixels * 3, 0.0);
    data_.distance.assign(pixels, 0.0);
    data_.object.assign(pixels, -1);
    data_.material.assign(pixels, -1);
    data_.aov_values.assign(pixels * aovs.size() * 4, 0.0);
    data_.aovs = std::move(aovs);
}

size_t Film::bytes(const Window& window, int batches, size_t aovs)
{
    const size_t of_batch = 3 * sizeof(double) + sizeof(int);
    const size_t of_pixel = (7 + 4 * aovs) * sizeof(double) + sizeof(float) + 2 * sizeof(int);
    return window.pixels() * (of_batch * size_t(batches) + of_pixel);
}

size_t Film::picture_bytes(size_t pixels, int batches, size_t aovs)
{
    const size_t of_errors = batches == batch_count ? 6 : 0;  // standard, predicted, its squares
    return pixels * sizeof(float) * (4 + 3 + 3 + 1 + 3 + of_errors + 4 * aovs);
}

size_t Film::pixel_at(int x, int y) const
{
    const Window& window = data_.window;
    return size_t(y - window.y) * size_t(window.width) + size_t(x - window.x);
}

void Film::add(const Dispatch& dispatch, const Results& results)
{
    for (size_t k = 0; k < dispatch.items.size(); ++k) {
        const WorkItem& item = dispatch.items[k];
        for (int in_item = 0; in_item < 1 << dispatch.pixel_shift; ++in_item) {
            const int x = item.x + even_bits(in_item);
            const int y = item.y + even_bits(in_item >> 1);
            if (!contains(data_.window, x, y)) continue;
            const int r = (int(k) << dispatch.pixel_shift) | in_item;
            const bool is_added = add_pixel(pixel_at(x, y), item, dispatch, results, r);
            const int dropped = is_added ? results.fault[size_t(r)] : dispatch.samples;
            if (dropped > 0) {
                if (data_.faults.count == 0) data_.faults = {0, x, y, item.first_sample};
                data_.faults.count += unsigned(dropped);
            }
            data_.texture_faults.add(dispatch, results, r, x, y, item.first_sample);
        }
    }
}

bool Film::add_pixel(size_t p, const WorkItem& item, const Dispatch& dispatch,
                     const Results& results, int r)
{
    const size_t n = size_t(dispatch.results());
    const size_t batch = data_.batches > 1 ? size_t(item.first_sample) / QUANTUM % batch_count : 0;
    const size_t b = p * size_t(data_.batches) + batch;
    bool is_finite = true;
    for (size_t c = 0; c < 3; ++c)
        is_finite = is_finite && std::isfinite(results.sum_radiance[c * n + size_t(r)]);
    for (size_t c = 0; c < 3; ++c) {
        if (is_finite) data_.radiance[b * 3 + c] += double(results.sum_radiance[c * n + size_t(r)]);
        data_.albedo[p * 3 + c] += double(results.sum_albedo[c * n + size_t(r)]);
        data_.normal[p * 3 + c] += double(results.sum_normal[c * n + size_t(r)]);
    }
    data_.alpha[p] += results.sum_alpha[size_t(r)];
    data_.distance[p] += double(results.sum_distance[size_t(r)]);
    const size_t aov_planes = 4 * data_.aovs.size();
    for (size_t c = 0; c < aov_planes; ++c)
        data_.aov_values[p * aov_planes + c] += double(results.sum_aov[c * n + size_t(r)]);
    if (item.first_sample == 0) {
        data_.object[p] = results.object_id[size_t(r)];
        data_.material[p] = results.material_id[size_t(r)];
    }
    data_.batch_samples[b] += dispatch.samples;
    return is_finite;
}

int Film::samples_of(size_t pixel) const
{
    int samples = 0;
    for (int b = 0; b < data_.batches; ++b)
        samples += data_.batch_samples[pixel * size_t(data_.batches) + size_t(b)];
    return samples;
}

std::array<float, 3> Film::mean_of(size_t pixel) const
{
    std::array<float, 3> mean{};
    const int samples = samples_of(pixel);
    for (size_t c = 0; c < 3 && samples > 0; ++c) {
        double sum = 0;
        for (size_t b = 0; b < size_t(data_.batches); ++b)
            sum += data_.radiance[(pixel * size_t(data_.batches) + b) * 3 + c];
        mean[c] = float(sum / samples);
    }
    return mean;
}

std::array<float, 3> Film::radiance(int x, int y) const
{
    return contains(data_.window, x, y) ? mean_of(pixel_at(x, y)) : std::array<float, 3>{};
}

std::array<float, 3> Film::standard_error(int x, int y) const
{
    return contains(data_.window, x, y) ? standard_error_of(pixel_at(x, y))
                                        : std::array<float, 3>{};
}

bool Film::is_error_known(int x, int y) const
{
    if (!contains(data_.window, x, y)) return false;
    const auto first =
        data_.batch_samples.begin() + std::ptrdiff_t(pixel_at(x, y) * size_t(data_.batches));
    return std::count_if(first, first + data_.batches, [](int n) { return n > 0; }) > 1;
}

std::array<float, 3> Film::albedo(int x, int y) const
{
    std::array<float, 3> mean{};
    if (!contains(data_.window, x, y)) return mean;
    const size_t p = pixel_at(x, y);
    const int samples = samples_of(p);
    for (size_t c = 0; c < 3 && samples > 0; ++c)
        mean[c] = float(data_.albedo[p * 3 + c] / samples);
    return mean;
}

void Film::forget_samples()
{
    FilmData fresh = Film(width_, height_, data_.window, data_.batches, data_.aovs).data_;
    fresh.object = std::move(data_.object);
    fresh.material = std::move(data_.material);
    fresh.faults = data_.faults;
    fresh.texture_faults = data_.texture_faults;
    data_ = std::move(fresh);
}

// Batch means weigh as many as their samples; the spread of n of them, each of N / n samples, is n
// times the variance of the mean of all N.
std::array<float, 3> Film::standard_error_of(size_t pixel) const
{
    std::array<float, 3> error{};
    const std::array<float, 3> mean = mean_of(pixel);
    for (size_t c = 0; c < 3; ++c) {
        double square = 0;
        int used = 0, samples = 0;
        for (size_t b = 0; b < size_t(data_.batches); ++b) {
            const size_t k = pixel * size_t(data_.batches) + b;
            const int n = data_.batch_samples[k];
            if (n == 0) continue;
            const double deviation = data_.radiance[k * 3 + c] / n - double(mean[c]);
            square += n * deviation * deviation;
            samples += n;
            ++used;
        }
        if (used > 1) error[c] = float(std::sqrt(square / (used - 1) / samples));
    }
    return error;
}

// A layer of means over all samples of the sums.
std::vector<float> Film::means(const std::vector<double>& sums, size_t channels) const
{
    std::vector<float> out(sums.size());
    for (size_t p = 0; p < data_.window.pixels(); ++p) {
        const int samples = samples_of(p);
        for (size_t c = 0; c < channels && samples > 0; ++c)
            out[p * channels + c] = float(sums[p * channels + c] / samples);
    }
    return out;
}

// A layer of means of one node, in as many channels as it gives numbers.
std::vector<float> Film::aov_means(size_t aov) const
{
    const size_t all = data_.aovs.size(), channels = size_t(data_.aovs[aov].channels);
    std::vector<double> sums(data_.window.pixels() * channels);
    for (size_t p = 0; p < data_.window.pixels(); ++p)
        std::copy_n(data_.aov_values.begin() + std::ptrdiff_t((p * all + aov) * 4), channels,
                    sums.begin() + std::ptrdiff_t(p * channels));
    return means(sums, channels);
}

std::vector<float> Film::beauty() const
{
    const size_t pixels = data_.window.pixels();
    std::vector<float> rgba(pixels * 4);
    for (size_t p = 0; p < pixels; ++p) {
        const std::array<float, 3> mean = mean_of(p);
        std::copy(mean.begin(), mean.end(), &rgba[p * 4]);
        const int samples = samples_of(p);
        if (samples > 0) rgba[p * 4 + 3] = data_.alpha[p] / float(samples);
    }
    return padded(std::move(rgba), data_.window, width_, height_);
}

image::Picture Film::picture() const
{
    const size_t pixels = data_.window.pixels();
    std::vector<float> errors(has_standard_error() ? pixels * 3 : 0);
    std::vector<uint32_t> counts(pixels), objects(pixels), materials(pixels);
    for (size_t p = 0; p < pixels; ++p) {
        counts[p] = uint32_t(samples_of(p));
        objects[p] = uint32_t(data_.object[p] + 1);  // 0: nothing was met
        materials[p] = uint32_t(data_.material[p] + 1);
        if (has_standard_error()) {
            const std::array<float, 3> error = standard_error_of(p);
            std::copy(error.begin(), error.end(), &errors[p * 3]);
        }
    }
    const auto whole = [&]<class Value>(std::vector<Value> layer) {
        return padded(std::move(layer), data_.window, width_, height_);
    };
    image::Picture picture;
    picture.width = width_;
    picture.height = height_;
    picture.layers.push_back(image::beauty_layer(beauty()));
    picture.layers.push_back(image::albedo_layer(whole(means(data_.albedo, 3))));
    picture.layers.push_back(image::normal_layer(whole(means(data_.normal, 3))));
    picture.layers.push_back(image::depth_layer(whole(means(data_.distance, 1))));
    picture.layers.push_back(image::id_layer("object_id", whole(std::move(objects))));
    picture.layers.push_back(image::id_layer("material_id", whole(std::move(materials))));
    picture.layers.push_back(image::id_layer("sample_count", whole(std::move(counts))));
    if (has_standard_error())
        picture.layers.push_back(image::standard_error_layer(whole(std::move(errors))));
    for (size_t k = 0; k < data_.aovs.size(); ++k)
        picture.layers.push_back(
            image::node_layer(data_.aovs[k].node, data_.aovs[k].channels, whole(aov_means(k))));
    return picture;
}

}  // namespace diptych
