// Laws of the sample sequence: stratified within a pixel and around it, independent between
// batches, and spread over the picture like blue noise.
#include "platform.h"

#include "common/random.h"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <set>
#include <vector>

namespace {

constexpr double pi = 3.14159265358979323846;

int pixel_at(int x, int y) { return x | y << 16; }

// Whether 2^bits points lie one in each cell of every grid of 2^a by 2^(bits - a) cells.
bool is_net(const std::vector<float2>& points, int bits)
{
    for (int a = 0; a <= bits; ++a) {
        const int across = 1 << a, down = 1 << (bits - a);
        std::set<int> cells;
        for (const float2& p : points)
            cells.insert(int(p.y * float(down)) * across + int(p.x * float(across)));
        if (cells.size() != points.size()) return false;
    }
    return true;
}

std::vector<float2> samples(int pixel, int first, int count, int dimension, int quanta = 0)
{
    std::vector<float2> points;
    for (int s = first; s < first + count; ++s)
        points.push_back(sample_pair(sample_key(7u, quanta, pixel, s), dimension));
    return points;
}

TEST(Random, EveryQuantumOfAPixelIsANet)
{
    for (const int pixel : {pixel_at(0, 0), pixel_at(5, 9), pixel_at(1023, 767)})
        for (const int dimension : {0, 1, 3, 17})
            for (int quantum = 0; quantum < 40; ++quantum)
                ASSERT_TRUE(is_net(samples(pixel, quantum * QUANTUM, QUANTUM, dimension), 4))
                    << quantum;
}

TEST(Random, NeighbouringPixelsContinueTheNet)
{
    for (int quantum = 0; quantum < 8; ++quantum) {
        for (const int dimension : {0, 2, 11}) {
            std::vector<float2> block;
            for (int k = 0; k < 16; ++k) {
                const std::vector<float2> own = samples(pixel_at(8 + (k & 3), 20 + (k >> 2)),
                                                        quantum * QUANTUM, QUANTUM, dimension);
                block.insert(block.end(), own.begin(), own.end());
            }
            ASSERT_TRUE(is_net(block, 8));
        }
    }
}

// One sequence for all samples: each pixel's are a net, and so are those of its neighbourhood.
TEST(Random, LongSequencesAreNetsOfAllTheirSamples)
{
    for (const int quanta : {1, 2, 3}) {
        const int count = QUANTUM << quanta, bits = 4 + quanta;
        for (const int dimension : {0, 2, 11}) {
            std::vector<float2> block;
            for (int k = 0; k < 4; ++k) {
                const std::vector<float2> own =
                    samples(pixel_at(8 + (k & 1), 20 + (k >> 1)), 0, count, dimension, quanta);
                ASSERT_TRUE(is_net(own, bits));
                block.insert(block.end(), own.begin(), own.end());
            }
            ASSERT_TRUE(is_net(block, bits + 2));
        }
    }
}

// Rounds of a batch continue the pixel's own sequence: two of them are a larger net.
TEST(Random, LaterRoundsContinueTheirSequence)
{
    const int round = 8 * QUANTUM, pixel = pixel_at(40, 3);
    std::vector<float2> points = samples(pixel, 2 * round, QUANTUM, 4);
    const std::vector<float2> more = samples(pixel, 3 * round, QUANTUM, 4);
    points.insert(points.end(), more.begin(), more.end());
    EXPECT_TRUE(is_net(points, 5));
}

TEST(Random, EveryCoordinateOfASampleMatters)
{
    const float2 a = sample_pair(sample_key(1u, 0, pixel_at(3, 4), 5), 6);
    const float2 again = sample_pair(sample_key(1u, 0, pixel_at(3, 4), 5), 6);
    EXPECT_EQ(a.x, again.x);
    EXPECT_EQ(a.y, again.y);
    EXPECT_NE(a.x, sample_pair(sample_key(2u, 0, pixel_at(3, 4), 5), 6).x);
    EXPECT_NE(a.x, sample_pair(sample_key(1u, 0, pixel_at(4, 4), 5), 6).x);
    EXPECT_NE(a.x, sample_pair(sample_key(1u, 0, pixel_at(3, 5), 5), 6).x);
    EXPECT_NE(a.x, sample_pair(sample_key(1u, 0, pixel_at(3, 4), 6), 6).x);
    EXPECT_NE(a.x, sample_pair(sample_key(1u, 0, pixel_at(3, 4), 5), 7).x);
}

// A smooth integrand of mean 0.
double wave(float2 p) { return std::cos(2.2 * p.x - 0.4) * (p.y + 0.5 * p.y * p.y); }
double wave_mean() { return (std::sin(1.8) + std::sin(0.4)) / 2.2 * (0.5 + 0.5 / 3); }

double quantum_error(int pixel, int quantum, int dimension, int count = QUANTUM)
{
    double sum = 0;
    for (const float2& p : samples(pixel, quantum * QUANTUM, count, dimension)) sum += wave(p);
    return sum / count - wave_mean();
}

double correlation(const std::vector<double>& a, const std::vector<double>& b)
{
    double aa = 0, bb = 0, ab = 0;
    for (size_t k = 0; k < a.size(); ++k) aa += a[k] * a[k], bb += b[k] * b[k], ab += a[k] * b[k];
    return ab / std::sqrt(aa * bb);
}

TEST(Random, BatchesAndDimensionsAreIndependent)
{
    constexpr int size = 64;
    std::vector<double> first, second, later, other;
    for (int y = 0; y < size; ++y) {
        for (int x = 0; x < size; ++x) {
            first.push_back(quantum_error(pixel_at(x, y), 0, 1));
            second.push_back(quantum_error(pixel_at(x, y), 1, 1));
            later.push_back(quantum_error(pixel_at(x, y), 8, 1));
            other.push_back(quantum_error(pixel_at(x, y), 0, 2));
        }
    }
    const double bound = 4.0 / size;  // four standard errors
    EXPECT_LT(std::abs(correlation(first, second)), bound);
    EXPECT_LT(std::abs(correlation(first, later)), bound);
    EXPECT_LT(std::abs(correlation(first, other)), bound);
}

// Mean power of the error's spectrum below a quarter of the highest frequency, over that of all
// frequencies: 1 for white noise.
double low_frequency_power(const std::vector<double>& image, int size)
{
    using Complex = std::complex<double>;
    std::vector<Complex> rows(image.size()), all(image.size());
    std::vector<Complex> turn(static_cast<size_t>(size));
    for (int k = 0; k < size; ++k) turn[size_t(k)] = std::polar(1.0, -2 * pi * k / size);
    const auto transform = [&](const auto& in, auto& out) {
        for (int y = 0; y < size; ++y)
            for (int k = 0; k < size; ++k) {
                Complex sum = 0;
                for (int x = 0; x < size; ++x)
                    sum += in[size_t(y * size + x)] * turn[size_t(k * x % size)];
                out[size_t(k * size + y)] = sum;  // transposed: the next pass goes down
            }
    };
    transform(image, rows);
    transform(rows, all);
    double low = 0, whole = 0;
    int low_count = 0, count = 0;
    for (int y = 0; y < size; ++y) {
        for (int x = 0; x < size; ++x) {
            const int u = std::min(x, size - x), v = std::min(y, size - y);
            if (u + v == 0) continue;
            const double power = std::norm(all[size_t(y * size + x)]);
            whole += power, ++count;
            if (u * u + v * v < size * size / 64) low += power, ++low_count;
        }
    }
    return low / low_count / (whole / count);
}

// By a quantum of samples; fewer leave their order within the quantum, which is shuffled for each
// pixel alone.
TEST(Random, ErrorOfAQuantumIsSpreadLikeBlueNoise)
{
    constexpr int size = 64;
    std::vector<double> error;
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x) error.push_back(quantum_error(pixel_at(x, y), 0, 1));
    const double low = low_frequency_power(error, size);
    RecordProperty("low_frequency_power", std::to_string(low));
    EXPECT_LT(low, 0.25);  // measured 0.14
}

}  // namespace
