// Texture filtering at the seams: what wrap modes promise there, on small images.
#include "platform.h"

#include "common/buffers.h"
#include "common/effects.h"
#include "common/textures/texture.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace {

// A scene of one image of float texels, a gradient whose red counts texels.
struct OneImage {
    std::vector<float4> texels;
    std::vector<uint> bytes{0};
    Image image;
    TextureSlot slot{};
    Scene scene{};

    OneImage(int width, int height, int wrap_u, int wrap_v, int filter)
        : image{width, height, 0, TEXELS_FLOAT}
    {
        for (int k = 0; k < width * height; ++k) texels.push_back({float(k), 0.5f, 0, 1});
        slot.wrap = wrap_u + 4 * wrap_v;
        slot.filter = filter;
        slot.to_u = {1, 0, 0, 0};
        slot.to_v = {0, 1, 0, 0};
    }
    float red(float u, float v)
    {
        scene.effects = EFFECT_FLOAT_TEXTURES;
        scene.images = &image;
        scene.texture_slots = &slot;
        scene.texels_float = texels.data();
        scene.texels_8 = bytes.data();
        return texture_read(&scene, 0, make_float2(u, v)).x;
    }
};

TEST(Texture, TexelCentresAreExact)
{
    for (const int filter : {TEXTURE_NEAREST, TEXTURE_LINEAR}) {
        OneImage image(4, 3, WRAP_CLAMP, WRAP_CLAMP, filter);
        for (int y = 0; y < 3; ++y)
            for (int x = 0; x < 4; ++x)
                EXPECT_NEAR(image.red((float(x) + 0.5f) / 4, (float(y) + 0.5f) / 3),
                            float(4 * y + x), 1e-5f);
    }
}

TEST(Texture, RepeatBlendsAcrossTheSeam)
{
    OneImage image(4, 1, WRAP_REPEAT, WRAP_REPEAT, TEXTURE_LINEAR);
    EXPECT_FLOAT_EQ(image.red(0, 0.5f), 1.5f);  // half way between texels 3 and 0
    EXPECT_FLOAT_EQ(image.red(1, 0.5f), 1.5f);
    EXPECT_FLOAT_EQ(image.red(-2, 0.5f), 1.5f);
    for (const float u : {0.1f, 0.37f, 0.9f}) {
        EXPECT_NEAR(image.red(u, 0.5f), image.red(u + 3, 0.5f), 1e-5f);
        EXPECT_NEAR(image.red(u, 0.5f), image.red(u - 5, 0.5f), 1e-5f);
    }
}

TEST(Texture, MirrorIsEvenAndContinuous)
{
    OneImage image(4, 1, WRAP_MIRROR, WRAP_MIRROR, TEXTURE_LINEAR);
    for (const float u : {0.05f, 0.3f, 0.62f, 0.99f}) {
        EXPECT_NEAR(image.red(u, 0.5f), image.red(-u, 0.5f), 1e-5f);
        EXPECT_NEAR(image.red(u, 0.5f), image.red(2 - u, 0.5f), 1e-5f);
        EXPECT_NEAR(image.red(u, 0.5f), image.red(4 + u, 0.5f), 1e-5f);
    }
    EXPECT_FLOAT_EQ(image.red(0, 0.5f), 0);
    EXPECT_FLOAT_EQ(image.red(1, 0.5f), 3);
}

TEST(Texture, ClampHoldsTheEdge)
{
    OneImage image(4, 1, WRAP_CLAMP, WRAP_CLAMP, TEXTURE_LINEAR);
    EXPECT_FLOAT_EQ(image.red(-7, 0.5f), 0);
    EXPECT_FLOAT_EQ(image.red(9, 0.5f), 3);
}

TEST(Texture, NearestTakesTheTexelAndStaysInside)
{
    for (const int wrap : {WRAP_REPEAT, WRAP_MIRROR, WRAP_CLAMP}) {
        OneImage image(3, 2, wrap, wrap, TEXTURE_NEAREST);
        for (int k = -4000; k < 4000; ++k) {
            const float u = float(k) * 0.00071f, v = 1 - u;
            const float red = image.red(u, v);
            ASSERT_TRUE(red >= 0 && red <= 5 && red == std::floor(red)) << u;
        }
        for (const float u : {1e20f, -1e20f, std::nextafter(1.0f, 0.0f), -1e-9f}) {
            const float red = image.red(u, u);
            EXPECT_TRUE(red >= 0 && red <= 5) << u;
        }
    }
}

TEST(Texture, SrgbBytesDecodeToTheStandard)
{
    for (unsigned byte = 0; byte < 256; ++byte) {
        const double x = byte / 255.0;
        const double linear = x <= 0.04045 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4);
        const float4 texel = texel_from_bytes(byte | byte << 24, TEXELS_8_SRGB);
        EXPECT_NEAR(texel.x, linear, 1e-6 + 2e-6 * linear) << byte;
        EXPECT_FLOAT_EQ(texel.w, float(x));
    }
}

}  // namespace
