// A wall of bricks in stretcher bond over the texture coordinates: each brick burnt a little
// differently, worn at its edges, in sandy mortar.
// Result: a colour and, as alpha, 1 on bricks and 0 in the mortar.
//
// size (float2, above 0; default [0.25, 0.0833]): of a brick with its joint, in texture coordinates
// joint (float, 0 to 0.5; default 0.13): width of the joints in heights of bricks
// brick_color (float3, linear Rec.709; default [0.36, 0.105, 0.058]): bricks on average
// burnt_color (float3, linear Rec.709; default [0.115, 0.040, 0.034]): the most burnt
// mortar_color (float3, linear Rec.709; default [0.46, 0.43, 0.38]): its sand
// wear (float, 0 to 1; default 0.5): how ragged the edges are

float4 brick(float2 size, float joint, float3 brick_color, float3 burnt_color,
             float3 mortar_color, float wear)
{
    const float2 place = readAttr("TexCoord0");
    const float aspect = size.x / size.y;
    const float y = place.y / size.y;
    const float row = floor(y);
    const float half_row = 0.5f * row;
    const float x = place.x / size.x + (half_row - floor(half_row));
    const float column = floor(x);
    // Coordinates in heights of bricks from here on.
    const float2 p = make_float2(x * aspect, y);
    const float3 solid = make_float3(p.x, p.y, 0.37f);
    const float ragged = noise3_of_two(solid * 3.1f, 11u);
    const float grit = noise3_of_two(solid * 14.0f, 21u);
    const float across = (0.5f - fabs(x - column - 0.5f)) * aspect;
    const float along = 0.5f - fabs(y - row - 0.5f);
    const float round_x = 0.16f - across > 0.0f ? 0.16f - across : 0.0f;
    const float round_y = 0.16f - along > 0.0f ? 0.16f - along : 0.0f;
    const float inside = 0.16f - sqrt(round_x * round_x + round_y * round_y);
    const float edge = inside - 0.5f * joint + wear * (0.045f * ragged + 0.02f * grit);
    const float on_brick = smoothstep(-0.006f, 0.022f, edge);
    const float2 own = hash_fractions2(hash2((int)column, (int)row, 31u));
    const float burnt = own.x * own.x * 0.85f + 0.22f * ragged;
    const float3 fired = mix(brick_color, burnt_color, clamp(burnt, 0.0f, 1.0f));
    const float worn = 1.0f - smoothstep(0.0f, 0.10f, edge);
    const float brightness = (0.82f + 0.36f * own.y) * (1.0f + 0.22f * grit) + 0.12f * worn;
    const float3 mortar = mortar_color * ((0.86f + 0.22f * grit) * (0.62f + 0.38f * smoothstep(-0.07f, -0.01f, -fabs(edge + 0.04f))));
    return to_float4(mix(mortar, fired * brightness, on_brick), on_brick);
}
