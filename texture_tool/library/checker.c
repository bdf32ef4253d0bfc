// A checkerboard over the texture coordinates, averaged over the pixel where its size is known.
// Result: a colour.
//
// scale (float, above 0; default 8): squares for each unit of the texture coordinates
// color_a (float3, linear Rec.709; default [0.75, 0.72, 0.65]): squares of even number
// color_b (float3, linear Rec.709; default [0.06, 0.06, 0.07]): squares of odd number

// The integral of a wave that is 1 over each even unit and -1 over each odd one.
float square_wave_integral(float x)
{
    const float half_x = 0.5f * x;
    const float rest = half_x - floor(half_x);
    return 1.0f - fabs(2.0f * rest - 1.0f);
}

// The mean of that wave over a width about x. Over the smallest width it is the wave itself.
float square_wave_mean(float x, float width)
{
    const float w = width > 1.0e-3f ? width : 1.0e-3f;
    const float upper = square_wave_integral(x + 0.5f * w);
    return (upper - square_wave_integral(x - 0.5f * w)) / w;
}

float3 checker(float scale, float3 color_a, float3 color_b)
{
    const float2 place = readAttr("TexCoord0");
    const float2 dx = readAttr("TexCoord0Dx");
    const float2 dy = readAttr("TexCoord0Dy");
    const float u = square_wave_mean(place.x * scale, (fabs(dx.x) + fabs(dy.x)) * scale);
    const float v = square_wave_mean(place.y * scale, (fabs(dx.y) + fabs(dy.y)) * scale);
    return mix(color_b, color_a, 0.5f + 0.5f * u * v);
}
