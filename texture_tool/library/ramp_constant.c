// A colour for each stretch of a value, changing at once at each position.
// Result: a colour.
//
// value (float, 0 to 1; default 0.5): usually another node's result
// colors (float3[], linear Rec.709; default [[0.02, 0.05, 0.10], [0.15, 0.35, 0.30], [0.90, 0.75, 0.40]]): 1 to 16 colours
// positions (float[], ascending; default [0.2, 0.5, 0.8]): where each colour is, or begins
// count (int, 1 to 16; default 3): how many of them

float3 ramp_constant(float value, const float3* colors, const float* positions, int count)
{
    return ramp_constant3(value, colors, positions, count);
}
