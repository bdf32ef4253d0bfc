// Wood, sawn from a trunk along the object's y axis: year rings that grow from pale earlywood to
// dark latewood and end abruptly, wavering along the trunk, with fibres and pores.
// Result: a colour.
//
// scale (float, 1/m, above 0; default 1): factor of the object's size
// rings (float, 1/m, above 0; default 13): year rings for each metre of radius
// waver (float, 0 to 1; default 0.35): how far the rings depart from circles
// early (float3, linear Rec.709; default [0.52, 0.30, 0.13]): earlywood, grown in spring
// late (float3, linear Rec.709; default [0.21, 0.085, 0.028]): latewood, grown in summer

float3 wood(float scale, float rings, float waver, float3 early, float3 late)
{
    const float3 place = readAttr("LocalPos");
    const float3 p = place * scale;
    // The trunk's heart lies off the middle, and bends.
    const float3 along = make_float3(p.x, 0.22f * p.y, p.z);
    const float bend = noise3_of_two(along * 1.6f, 11u);
    const float bump = perlin3_seeded(along * 4.5f, 21u);
    const float x = p.x + 0.21f + 0.10f * perlin3_seeded(make_float3(0.0f, 0.7f * p.y, 0.5f), 31u);
    const float z = p.z + 0.13f;
    const float radius = sqrt(x * x + z * z) + waver * (0.16f * bend + 0.03f * bump);
    const float year = radius * rings;
    const float age = year - floor(year);
    // Years differ in how dark their latewood turns.
    const float strength = 0.70f + 0.45f * hash_fraction(hash1((int)floor(year), 41u));
    const float grown = age * (0.25f + 0.75f * age * age) * (1.0f - smoothstep(0.92f, 1.0f, age));
    // Fibres run along the trunk; pores are the darkest of them, most in earlywood.
    const float3 fibre_place = make_float3(p.x * 70.0f, p.y * 2.2f, p.z * 70.0f);
    const float fibre = perlin3_seeded(fibre_place, 51u);
    const float pore_noise = perlin3_seeded(fibre_place * 2.1f, 61u);
    const float pore = smoothstep(0.32f, 0.55f, pore_noise) * (1.0f - 0.6f * grown);
    const float3 grain = mix(early, late, clamp(strength * grown * (1.0f + 0.18f * fibre), 0.0f, 1.0f));
    return grain * ((1.0f + 0.13f * fibre + 0.10f * bend) * (1.0f - 0.45f * pore));
}
