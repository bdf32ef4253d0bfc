// Rust over grey metal or paint, as in "Restricted Extensions for GPU Photo-realistic Renderer":
// diffuse grey and a rust of noises and colour ramps, blended by a mask of noise and occlusion, so
// that it creeps out of corners and crevices where water stays.
// Result: a colour and, as alpha, how much of it is rust.
//
// scale (float, 1/m, above 0; default 3): patches for each metre of the object
// amount (float, 0 to 1; default 0.5): how much is rusted in the open
// creep (float, 0 to 2; default 0.9): how much more in crevices
// reach (float, m, 0 for the scene's default; default 0.25): how far occlusion is felt
// base (float3, linear Rec.709; default [0.5, 0.5, 0.5]): the metal or paint

// Iron oxides by age: dry ochre, orange, red-brown, nearly black.
float3 rust_color(float t)
{
    const float3 ochre = make_float3(0.50f, 0.215f, 0.060f);
    const float3 orange = make_float3(0.36f, 0.098f, 0.020f);
    const float3 brown = make_float3(0.135f, 0.035f, 0.012f);
    const float3 black = make_float3(0.038f, 0.016f, 0.011f);
    const float3 young = mix(orange, ochre, smoothstep(0.56f, 0.82f, t));
    const float3 aged = mix(brown, young, smoothstep(0.36f, 0.58f, t));
    return mix(black, aged, smoothstep(0.12f, 0.36f, t));
}

float4 rust(float scale, float amount, float creep, float reach, float3 base)
{
    const float open = readOcclusion("upper", reach);
    const float3 place = readAttr("LocalPos");
    const float3 p = place * scale;
    const float patches = noise3_of_two(p, 11u);
    const float blots = noise3_of_two(p * 4.3f, 21u);
    const float grains = perlin3_seeded(p * 23.0f, 31u);
    const float level = amount - 0.5f + creep * (1.0f - open);
    const float ground = patches + 0.45f * blots + 0.16f * grains;
    const float mask = smoothstep(-0.05f, 0.09f, ground + level);
    // Rust is oldest where it began, youngest at its border.
    const float depth = ground + level;
    const float3 rusted = rust_color(0.52f - 0.45f * depth + 0.55f * blots + 0.22f * grains);
    // A stain runs ahead of the rust.
    const float stain = 0.35f * smoothstep(-0.30f, 0.0f, depth);
    const float3 stained = mix(base, base * make_float3(0.80f, 0.52f, 0.30f), stain);
    return to_float4(mix(stained, rusted * (1.0f + 0.25f * grains), mask), mask);
}
