// Pixel filters by importance sampling: samples are spread as the filter weighs them, and all count
// the same, so a pixel never depends on its neighbours' samples.
#pragma once

#include "platform.h"

#include "common/layout.h"

// The 4-term Blackman-Harris window (Harris 1978) on [-1, 1]: the distance x from its centre beyond
// which one side has the share (k / 64)^2 of its weight. Steps of equal share would leave the
// window's long tails to a single one.
// clang-format off
CONSTANT float blackman_harris_quantiles[65] = {
    1.00000000f, 0.88645493f, 0.82765653f, 0.78456353f, 0.74960403f, 0.71972828f, 0.69336575f, 0.66959176f,
    0.64781208f, 0.62762022f, 0.60872476f, 0.59090898f, 0.57400689f, 0.55788821f, 0.54244861f, 0.52760308f,
    0.51328127f, 0.49942426f, 0.48598207f, 0.47291189f, 0.46017671f, 0.44774427f, 0.43558619f, 0.42367738f,
    0.41199547f, 0.40052042f, 0.38923413f, 0.37812021f, 0.36716370f, 0.35635089f, 0.34566915f, 0.33510679f,
    0.32465292f, 0.31429738f, 0.30403061f, 0.29384360f, 0.28372779f, 0.27367505f, 0.26367758f, 0.25372787f,
    0.24381868f, 0.23394297f, 0.22409385f, 0.21426460f, 0.20444856f, 0.19463915f, 0.18482981f, 0.17501398f,
    0.16518504f, 0.15533635f, 0.14546110f, 0.13555237f, 0.12560307f, 0.11560587f, 0.10555317f, 0.09543708f,
    0.08524931f, 0.07498118f, 0.06462350f, 0.05416652f, 0.04359986f, 0.03291237f, 0.02209207f, 0.01112598f,
    0.00000000f
};
// clang-format on

#define BLACKMAN_HARRIS_RADIUS 1.5f  // pixels

SHARED float blackman_harris_sample(float u)
{
    const float share = 1.0f - math_abs(2.0f * u - 1.0f);
    const float scaled = math_sqrt(share) * 64.0f;
    const int cell = (int)scaled;
    const int k = cell > 63 ? 63 : cell;
    const float nearer = blackman_harris_quantiles[k + 1];
    const float farther = blackman_harris_quantiles[k];
    const float distance = farther + (nearer - farther) * (scaled - (float)k);
    const float side = u < 0.5f ? -BLACKMAN_HARRIS_RADIUS : BLACKMAN_HARRIS_RADIUS;
    return distance * side;
}

// Offset from the pixel's centre, in pixels. u in [0, 1)^2.
SHARED float2 filter_sample(int filter, float2 u)
{
    const float smooth_x = blackman_harris_sample(u.x);
    const float smooth_y = blackman_harris_sample(u.y);
    const float box =
        filter == FILTER_BOX ? 1.0f : 0.0f;  // a factor: the choice is the same for all paths
    const float smooth = 1.0f - box;
    return make_float2((u.x - 0.5f) * box + smooth_x * smooth,
                       (u.y - 0.5f) * box + smooth_y * smooth);
}
