// Simplex noise through the object, about its middle 1/2: rounder and cheaper than Perlin's, with
// no grid to be seen.
// Result: a value in [0, 1].
//
// scale (float, 1/m, above 0; default 4): features for each metre of the object

float simplex(float scale)
{
    const float3 place = readAttr("LocalPos");
    return 0.5f + 0.5f * simplex3(place * scale);
}
