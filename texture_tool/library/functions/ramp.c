// Colours along [0, 1]: `count` colours (1 to 16) at ascending positions. Before the first position
// the first colour holds, after the last the last one.

// Each colour from its position on.
float3 ramp_constant3(float t, const float3* colors, const float* positions, int count)
{
    float3 color = colors[0];
    for (int i = 1; i < 16; ++i) {
        const int k = i < count ? i : count - 1;
        const float3 next = colors[k];
        const int is_past = t >= positions[k];
        color = make_float3(is_past ? next.x : color.x, is_past ? next.y : color.y,
                            is_past ? next.z : color.z);
    }
    return color;
}

// How far t is from a to b, in [0, 1]; one also where a = b and t has passed them.
float ramp_share(float t, float a, float b)
{
    return clamp((t - a) / fmax(b - a, 1.0e-7f), 0.0f, 1.0f);
}

// Straight between neighbours.
float3 ramp_linear3(float t, const float3* colors, const float* positions, int count)
{
    float3 color = colors[0];
    float before = positions[0];
    for (int i = 1; i < 16; ++i) {
        const int k = i < count ? i : count - 1;
        const float share = i < count ? ramp_share(t, before, positions[k]) : 0.0f;
        before = positions[k];
        color = color * (1.0f - share) + colors[k] * share;
    }
    return color;
}

// By smoothstep between neighbours: flat at each position.
float3 ramp_smooth3(float t, const float3* colors, const float* positions, int count)
{
    float3 color = colors[0];
    float before = positions[0];
    for (int i = 1; i < 16; ++i) {
        const int k = i < count ? i : count - 1;
        const float share = i < count ? ramp_share(t, before, positions[k]) : 0.0f;
        before = positions[k];
        const float smooth = share * share * (3.0f - 2.0f * share);
        color = color * (1.0f - smooth) + colors[k] * smooth;
    }
    return color;
}
