// Two colours by a mask, which other nodes may give.
// Result: a colour, its alpha blended likewise.
//
// below (float4, linear Rec.709 and alpha; default [0.5, 0.5, 0.5, 1]): where the mask is 0
// above (float4, linear Rec.709 and alpha; default [0.2, 0.05, 0.02, 1]): where it is 1
// mask (float, 0 to 1; default 0.5): clamped

float4 blend(float4 below, float4 above, float mask)
{
    const float share = clamp(mask, 0.0f, 1.0f);
    return below * (1.0f - share) + above * share;
}
