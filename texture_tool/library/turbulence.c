// Perlin's turbulence through the object: absolute values of octaves, like billowing smoke, or with
// 1 - value like ridges.
// Result: a value in [0, 1], 0 in the creases.
//
// scale (float, 1/m, above 0; default 2): cells for each metre of the object in the first octave
// octaves (float, 0 to 8; default 6): how many, the last fading in
// lacunarity (float, above 1; default 2): ratio of frequencies of neighbouring octaves
// gain (float, 0 to 1; default 0.5): ratio of their weights
// contrast (float, above 0; default 2): factor of the result, before it is clamped

float turbulence(float scale, float octaves, float lacunarity, float gain, float contrast)
{
    const float3 place = readAttr("LocalPos");
    const float noise = turbulence3(place * scale, octaves, lacunarity, gain);
    return clamp(contrast * noise, 0.0f, 1.0f);
}
