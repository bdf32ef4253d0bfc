// Fractional Brownian motion through the object: octaves of Perlin's noise, about the middle 1/2.
// Result: a value in [0, 1].
//
// scale (float, 1/m, above 0; default 2): cells for each metre of the object in the first octave
// octaves (float, 0 to 8; default 6): how many, the last fading in
// lacunarity (float, above 1; default 2): ratio of frequencies of neighbouring octaves
// gain (float, 0 to 1; default 0.5): ratio of their weights
// contrast (float, above 0; default 1.8): how far the result leaves 1/2, before it is clamped

float fbm(float scale, float octaves, float lacunarity, float gain, float contrast)
{
    const float3 place = readAttr("LocalPos");
    const float noise = fbm3(place * scale, octaves, lacunarity, gain);
    return clamp(0.5f + 0.5f * contrast * noise, 0.0f, 1.0f);
}
