#include "host/render/film.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace diptych {
namespace {

int batches_for(int samples) { return samples >= standard_error_samples ? batch_count : 1; }

// x or y of entry k of a work item: the even bits of its Morton code.
int even_bits(int k)
{
    int out = 0;
    for (int bit = 0; bit < BLOCK_SHIFT; ++bit) out |= (k >> (2 * bit) & 1) << bit;
    return out;
}

// Sums of finite samples may overflow; below this, those of all batches together do not.
constexpr float largest_sum = std::numeric_limits<float>::max() / (2 * batch_count);

bool has_room(float sum, float more) { return std::abs(sum + more) <= largest_sum; }

}  // namespace

Film::Film(int width, int height, int samples)
    : width_(width), height_(height), batches_(batches_for(samples))
{
    const size_t pixels = size_t(width) * size_t(height);
    radiance_.assign(pixels * size_t(batches_) * 3, 0.0f);
    batch_samples_.assign(pixels * size_t(batches_), 0);
    alpha_.assign(pixels, 0.0f);
    albedo_.assign(pixels * 3, 0.0f);
    normal_.assign(pixels * 3, 0.0f);
    distance_.assign(pixels, 0.0f);
    object_.assign(pixels, -1);
    material_.assign(pixels, -1);
}

size_t Film::bytes(int width, int height, int samples)
{
    return size_t(width) * size_t(height) * size_t(batches_for(samples) * 16 + 40);
}

void Film::add(const Dispatch& dispatch, const Results& results)
{
    for (size_t k = 0; k < dispatch.items.size(); ++k) {
        const WorkItem& item = dispatch.items[k];
        const int batch = batches_ == 1 ? 0 : item.first_sample / QUANTUM % batch_count;
        for (int in_item = 0; in_item < 1 << dispatch.pixel_shift; ++in_item) {
            const int x = item.x + even_bits(in_item);
            const int y = item.y + even_bits(in_item >> 1);
            if (x >= width_ || y >= height_) continue;
            const int r = (int(k) << dispatch.pixel_shift) | in_item;
            const bool is_added = add_pixel(y * width_ + x, batch, dispatch, results, r);
            const int dropped = is_added ? results.fault[size_t(r)] : dispatch.samples;
            if (dropped > 0) {
                if (faults_.count == 0) faults_ = {0, x, y, item.first_sample};
                faults_.count += unsigned(dropped);
            }
        }
    }
}

bool Film::add_pixel(int pixel, int batch, const Dispatch& dispatch, const Results& results, int r)
{
    const size_t p = size_t(pixel);
    const size_t n = size_t(dispatch.results());
    const size_t b = p * size_t(batches_) + size_t(batch);
    bool fits = true;
    for (size_t c = 0; c < 3; ++c)
        fits = fits && has_room(radiance_[b * 3 + c], results.sum_radiance[c * n + size_t(r)]);
    for (size_t c = 0; c < 3; ++c) {
        if (fits) radiance_[b * 3 + c] += results.sum_radiance[c * n + size_t(r)];
        albedo_[p * 3 + c] += results.sum_albedo[c * n + size_t(r)];
        normal_[p * 3 + c] += results.sum_normal[c * n + size_t(r)];
    }
    alpha_[p] += results.sum_alpha[size_t(r)];
    distance_[p] += results.sum_distance[size_t(r)];
    if (batch_samples_[p * size_t(batches_)] == 0) {
        object_[p] = results.object_id[size_t(r)];
        material_[p] = results.material_id[size_t(r)];
    }
    batch_samples_[b] += dispatch.samples;
    return fits;
}

std::vector<float> Film::means(const std::vector<float>& sums, int channels) const
{
    std::vector<float> out(sums.size());
    for (size_t p = 0; p < alpha_.size(); ++p) {
        int samples = 0;
        for (int b = 0; b < batches_; ++b)
            samples += batch_samples_[p * size_t(batches_) + size_t(b)];
        for (size_t c = 0; c < size_t(channels); ++c)
            out[p * size_t(channels) + c] =
                samples > 0 ? sums[p * size_t(channels) + c] / float(samples) : 0.0f;
    }
    return out;
}

std::vector<float> Film::standard_error() const
{
    std::vector<float> out(albedo_.size());
    for (size_t p = 0; p < alpha_.size(); ++p) {
        for (size_t c = 0; c < 3; ++c) {
            double sum = 0, square = 0;
            int used = 0;
            for (size_t b = 0; b < size_t(batches_); ++b) {
                const int samples = batch_samples_[p * size_t(batches_) + b];
                if (samples == 0) continue;
                const double mean = double(radiance_[(p * size_t(batches_) + b) * 3 + c]) / samples;
                sum += mean;
                square += mean * mean;
                ++used;
            }
            if (used < 2) continue;
            const double variance = std::max(0.0, square - sum * sum / used) / (used - 1);
            out[p * 3 + c] = float(std::sqrt(variance / used));
        }
    }
    return out;
}

image::Picture Film::picture() const
{
    image::Picture picture;
    picture.width = width_;
    picture.height = height_;
    const size_t pixels = alpha_.size();
    std::vector<float> sums(pixels * 3);
    std::vector<uint32_t> counts(pixels), objects(pixels), materials(pixels);
    for (size_t p = 0; p < pixels; ++p) {
        for (size_t b = 0; b < size_t(batches_); ++b) {
            counts[p] += uint32_t(batch_samples_[p * size_t(batches_) + b]);
            for (size_t c = 0; c < 3; ++c)
                sums[p * 3 + c] += radiance_[(p * size_t(batches_) + b) * 3 + c];
        }
        objects[p] = uint32_t(object_[p] + 1);  // 0: nothing was met
        materials[p] = uint32_t(material_[p] + 1);
    }
    const std::vector<float> radiance = means(sums, 3);
    const std::vector<float> alpha = means(alpha_, 1);
    std::vector<float> rgba(pixels * 4);
    for (size_t p = 0; p < pixels; ++p) {
        for (size_t c = 0; c < 3; ++c) rgba[p * 4 + c] = radiance[p * 3 + c];
        rgba[p * 4 + 3] = alpha[p];
    }
    picture.layers.push_back(image::beauty_layer(std::move(rgba)));
    picture.layers.push_back(image::albedo_layer(means(albedo_, 3)));
    picture.layers.push_back(image::normal_layer(means(normal_, 3)));
    picture.layers.push_back(image::depth_layer(means(distance_, 1)));
    picture.layers.push_back(image::id_layer("object_id", std::move(objects)));
    picture.layers.push_back(image::id_layer("material_id", std::move(materials)));
    picture.layers.push_back(image::id_layer("sample_count", std::move(counts)));
    if (has_standard_error())
        picture.layers.push_back(image::standard_error_layer(standard_error()));
    return picture;
}

}  // namespace diptych
