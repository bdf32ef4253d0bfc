// Reading images: one source of filtering for every backend, so that a texel is the same colour
// everywhere.
#pragma once

#include "platform.h"

#include "common/buffers.h"
#include "common/effects.h"
#include "common/math.h"

// The sRGB transfer function of IEC 61966-2-1, relative error below 3e-6; x in [0, 1]. The
// power 2.4 as s^4 * s^0.8 with s = sqrt(t), the second factor a minimax polynomial.
SHARED float srgb_decode(float x)
{
    const float t = (x + 0.055f) * (1.0f / 1.055f);
    const float s = math_sqrt(t);
    const float p = 0.031431893f +
                    s * (1.385667162f +
                         s * (-1.028371908f +
                              s * (1.292328602f +
                                   s * (-1.118102203f + s * (0.555984845f + s * -0.118940203f)))));
    return x <= 0.04045f ? x * (1.0f / 12.92f) : t * t * p;
}

SHARED float4 texel_from_bytes(uint bytes, int encoding)
{
    const float r = (float)(int)(bytes & 255u) * (1.0f / 255.0f);
    const float g = (float)(int)((bytes >> 8) & 255u) * (1.0f / 255.0f);
    const float b = (float)(int)((bytes >> 16) & 255u) * (1.0f / 255.0f);
    const float a = (float)(int)(bytes >> 24) * (1.0f / 255.0f);
    const float linear_r = srgb_decode(r);
    const float linear_g = srgb_decode(g);
    const float linear_b = srgb_decode(b);
    const int is_srgb = encoding == TEXELS_8_SRGB;
    return make_float4(is_srgb ? linear_r : r, is_srgb ? linear_g : g, is_srgb ? linear_b : b, a);
}

// The texel at `index` of an image that begins at `first`; the array the image does not lie in is
// read at its start.
SHARED float4 texel_read(const Scene* scene, int first, int encoding, int index)
{
    if (!uses(scene, EFFECT_FLOAT_TEXTURES))
        return texel_from_bytes(ROW_AT(scene, texels_8, first + index), encoding);
    const int is_float = encoding == TEXELS_FLOAT;
    const int k = (first + index) & -is_float;
    const float4 bytes =
        texel_from_bytes(ROW_AT(scene, texels_8, (first + index) & (is_float - 1)), encoding);
    const float r = ROW_AT(scene, texels_float, k).x;
    const float g = ROW_AT(scene, texels_float, k).y;
    const float b = ROW_AT(scene, texels_float, k).z;
    const float a = ROW_AT(scene, texels_float, k).w;
    const float f =
        (float)is_float;  // factors, not selects: a select would make the loads conditional
    const float e = 1.0f - f;
    return make_float4(r * f + bytes.x * e, g * f + bytes.y * e, b * f + bytes.z * e,
                       a * f + bytes.w * e);
}

// A texture coordinate brought into [0, 1].
SHARED float wrap_coordinate(float x, int wrap)
{
    const float repeated = x - math_floor(x);
    const float half_way = x * 0.5f;
    const float folded = 2.0f * (half_way - math_floor(half_way));
    const float mirrored = 1.0f - math_abs(1.0f - folded);
    const float clamped = math_clamp(x, 0.0f, 1.0f);
    return wrap == WRAP_REPEAT ? repeated : (wrap == WRAP_MIRROR ? mirrored : clamped);
}

// A texel's column (or row) that may lie one outside the image.
SHARED int wrap_texel(int k, int size, int wrap)
{
    const int low = wrap == WRAP_REPEAT ? size - 1 : 0;
    const int high = wrap == WRAP_REPEAT ? 0 : size - 1;
    return k < 0 ? low : (k >= size ? high : k);
}

// The image of a slot at texture coordinates (u, v), v downwards as glTF has it; linear colour,
// alpha straight. slot < 0 gives white. wrap, filter: as in TextureSlot.
SHARED float4 texture_read_with(const Scene* scene, int slot, float2 uv, int wrap, int filter)
{
    const int s = slot < 0 ? 0 : slot;
    const int image = scene->texture_slots[s].image;
    const int is_linear = filter == TEXTURE_LINEAR;
    const float u = scene->texture_slots[s].to_u.x * uv.x + scene->texture_slots[s].to_u.y * uv.y +
                    scene->texture_slots[s].to_u.z;
    const float v = scene->texture_slots[s].to_v.x * uv.x + scene->texture_slots[s].to_v.y * uv.y +
                    scene->texture_slots[s].to_v.z;
    const int width = scene->images[image].width;
    const int height = scene->images[image].height;
    const int first = scene->images[image].first_texel;
    const int encoding = scene->images[image].encoding;

    const int wrap_u = wrap & 3;
    const int wrap_v = wrap >> 2;
    const float offset = is_linear ? 0.5f : 0.0f;
    const float x = wrap_coordinate(u, wrap_u) * (float)width - offset;
    const float y = wrap_coordinate(v, wrap_v) * (float)height - offset;
    const float floor_x = math_floor(x);
    const float floor_y = math_floor(y);
    const float fx = is_linear ? x - floor_x : 0.0f;
    const float fy = is_linear ? y - floor_y : 0.0f;
    const int x0 = wrap_texel((int)floor_x, width, wrap_u);
    const int y0 = wrap_texel((int)floor_y, height, wrap_v);
    const int x1 = wrap_texel((int)floor_x + 1, width, wrap_u);
    const int y1 = wrap_texel((int)floor_y + 1, height, wrap_v);

    const float4 t00 = texel_read(scene, first, encoding, y0 * width + x0);
    const float4 t10 = texel_read(scene, first, encoding, y0 * width + x1);
    const float4 t01 = texel_read(scene, first, encoding, y1 * width + x0);
    const float4 t11 = texel_read(scene, first, encoding, y1 * width + x1);
    const float4 top = t00 * (1.0f - fx) + t10 * fx;
    const float4 bottom = t01 * (1.0f - fx) + t11 * fx;
    const float4 value = top * (1.0f - fy) + bottom * fy;
    const int is_bound = slot >= 0;
    return make_float4(is_bound ? value.x : 1.0f, is_bound ? value.y : 1.0f,
                       is_bound ? value.z : 1.0f, is_bound ? value.w : 1.0f);
}

// The same with the slot's own wrapping and filter.
SHARED float4 texture_read(const Scene* scene, int slot, float2 uv)
{
    const int s = slot < 0 ? 0 : slot;
    return texture_read_with(scene, slot, uv, scene->texture_slots[s].wrap,
                             scene->texture_slots[s].filter);
}
