// Gabor noise over the texture coordinates: waves of one length, in one direction or in many, as in
// brushed metal, woven cloth or rippled sand.
// Result: a value in [0, 1], about its middle 1/2.
//
// scale (float, above 0; default 8): kernels for each unit of the texture coordinates
// frequency (float, 0 to 8; default 2.5): waves for each kernel
// turn (float, revolutions; default 0.08): direction of the waves
// spread (float, 0 to 1; default 0.15): 0 for parallel waves, 1 for all directions alike
// contrast (float, above 0; default 0.8): how far the result leaves 1/2, before it is clamped

float gabor(float scale, float frequency, float turn, float spread, float contrast)
{
    const float2 place = readAttr("TexCoord0");
    const float noise = gabor2(place * scale, frequency, turn, spread);
    return clamp(0.5f + 0.5f * contrast * noise, 0.0f, 1.0f);
}
