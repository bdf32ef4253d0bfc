// Perlin's gradient noise through the object, about its middle 1/2.
// Result: a value in [0, 1].
//
// scale (float, 1/m, above 0; default 4): cells for each metre of the object

float perlin(float scale)
{
    const float3 place = readAttr("LocalPos");
    return 0.5f + 0.5f * perlin3(place * scale);
}
