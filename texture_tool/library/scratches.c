// Scratches over the texture coordinates, as in "Restricted Extensions for GPU Photo-realistic
// Renderer": the borders of stretched Voronoi cells, bent and broken off by noise.
// Result: a colour and, as alpha, how scratched it is.
//
// scale (float, above 0; default 3): cells for each unit of the texture coordinates
// width (float, 0 to 1; default 0.02): of the scratches in cells
// amount (float, 0 to 1; default 0.5): how many there are
// base (float3, linear Rec.709; default [0.24, 0.25, 0.27]): between them
// scratch (float3, linear Rec.709; default [0.72, 0.72, 0.70]): in their middle

// One layer of lines, whose long direction turns by (cosine, sine).
float scratch_layer(float2 p, float2 turn, float width, uint seed)
{
    const float x = p.x * turn.x + p.y * turn.y;
    const float y = p.y * turn.x - p.x * turn.y;
    const float border = voronoi2_border(make_float2(0.22f * x, 2.2f * y), 0.92f, seed);
    const float inside = 1.0f - border / width;
    return inside > 0.0f ? inside : 0.0f;
}

float4 scratches(float scale, float width, float amount, float3 base, float3 scratch)
{
    const float2 place = readAttr("TexCoord0");
    const float2 p = place * scale;
    const float bend = perlin2_seeded(p * 0.9f, 11u);
    const float broken = perlin2_seeded(p * 1.7f, 21u);
    const float2 q = make_float2(p.x + 0.10f * bend, p.y - 0.07f * bend);
    const float one = scratch_layer(q, make_float2(0.9135f, 0.4067f), width, 31u);
    const float two = scratch_layer(q, make_float2(0.1908f, 0.9816f), 0.7f * width, 41u);
    const float many = 2.0f * amount - 1.0f;
    const float lines_one = one * smoothstep(-0.12f, 0.30f, many + broken);
    const float lines_two = two * smoothstep(-0.12f, 0.30f, many - broken);
    const float scratched = lines_one > lines_two ? lines_one : lines_two;
    const float dull = 1.0f + 0.10f * bend + 0.06f * broken;
    return to_float4(mix(base * dull, scratch, scratched), scratched);
}
