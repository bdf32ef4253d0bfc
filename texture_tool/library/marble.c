// Marble, cut from a block: veins where bent noise passes zero, broad and fine, in cloudy stone.
// Result: a colour.
//
// scale (float, 1/m, above 0; default 1.5): size of the large veins' pattern
// bend (float, 0 to 2; default 0.9): how strongly the veins are folded
// vein_width (float, above 0; default 0.035): of the large veins, in their noise's units
// stone (float3, linear Rec.709; default [0.80, 0.79, 0.77]): between the veins
// cloud (float3, linear Rec.709; default [0.52, 0.53, 0.56]): where the stone is greyest
// vein (float3, linear Rec.709; default [0.10, 0.11, 0.13]): in the middle of the veins

// 1 in the middle of a vein, falling to 0 on both sides.
float marble_vein(float noise, float width)
{
    return width / (width + fabs(noise) * fabs(noise) / width);
}

float3 marble(float scale, float bend, float vein_width, float3 stone, float3 cloud, float3 vein)
{
    const float3 place = readAttr("LocalPos");
    const float3 p = place * scale;
    const float3 fold = make_float3(noise3_of_two(p, 21u), noise3_of_two(p, 31u),
                                    noise3_of_two(p, 41u));
    const float3 q = p + fold * bend;
    const float veined = 0.5f + 0.5f * perlin3_seeded(p * 1.3f, 51u);
    const float large = marble_vein(noise3_of_three(q, 61u), vein_width);
    const float fine = marble_vein(noise3_of_two(q * 2.6f + fold, 71u), 0.4f * vein_width);
    const float grey = smoothstep(0.2f, 0.75f, 0.5f + 0.9f * noise3_of_two(q * 1.3f, 81u));
    const float grain = perlin3_seeded(p * 60.0f, 91u);
    const float3 ground = mix(stone, cloud, 0.9f * grey * veined);
    const float dark = clamp(large * (0.35f + 0.65f * veined) + 0.45f * fine * veined, 0.0f, 1.0f);
    return mix(ground, vein, dark) * (1.0f + 0.03f * grain);
}
