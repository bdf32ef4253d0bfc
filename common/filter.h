// Pixel filters by importance sampling: samples are spread as the filter weighs them, and all count
// the same, so a pixel never depends on its neighbours' samples.
#pragma once

#include "platform.h"

#include "common/layout.h"

// Quantiles of the 4-term Blackman-Harris window (Harris 1978) on [-1, 1], k / 64 each.
// clang-format off
CONSTANT float blackman_harris_quantiles[65] = {
    -1.00000000f, -0.58551504f, -0.51328127f, -0.46528460f, -0.42808674f, -0.39713563f, -0.37029498f, -0.34637822f,
    -0.32465292f, -0.30463276f, -0.28597699f, -0.26843670f, -0.25182401f, -0.23599316f, -0.22082846f, -0.20623631f,
    -0.19213965f, -0.17847408f, -0.16518504f, -0.15222575f, -0.13955559f, -0.12713894f, -0.11494422f, -0.10294315f,
    -0.09111015f, -0.07942187f, -0.06785677f, -0.05639478f, -0.04501705f, -0.03370566f, -0.02244340f, -0.01121362f,
    -0.00000000f, 0.01121362f, 0.02244340f, 0.03370566f, 0.04501705f, 0.05639478f, 0.06785677f, 0.07942187f,
    0.09111015f, 0.10294315f, 0.11494422f, 0.12713894f, 0.13955559f, 0.15222575f, 0.16518504f, 0.17847408f,
    0.19213965f, 0.20623631f, 0.22082846f, 0.23599316f, 0.25182401f, 0.26843670f, 0.28597699f, 0.30463276f,
    0.32465292f, 0.34637822f, 0.37029498f, 0.39713563f, 0.42808674f, 0.46528460f, 0.51328127f, 0.58551504f,
    1.00000000f
};
// clang-format on

#define BLACKMAN_HARRIS_RADIUS 1.5f  // pixels

SHARED float blackman_harris_sample(float u)
{
    const float scaled = u * 64.0f;
    const int k = (int)scaled;
    const float low = blackman_harris_quantiles[k];
    const float high = blackman_harris_quantiles[k + 1];
    return (low + (high - low) * (scaled - (float)k)) * BLACKMAN_HARRIS_RADIUS;
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
