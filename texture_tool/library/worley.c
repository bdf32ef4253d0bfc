// Worley's cellular noise through the object: a sum of the distances F1, F2 to the nearest and the
// second nearest point, in cells.
// Result: a value in [0, 1].
//
// scale (float, 1/m, above 0; default 4): cells for each metre of the object
// jitter (float, 0 to 1; default 0.87): how far points stray from the middles of their cells
// metric (int, 0 to 2; default 0): distances by Euclid, by the sum or by the largest difference
// weights (float2; default [1, 0]): of F1 and F2; [-1, 1] draws the cells' borders in black

float worley(float scale, float jitter, int metric, float2 weights)
{
    const float3 place = readAttr("LocalPos");
    const float2 distances = worley3_metric(place * scale, jitter, metric, 0u);
    return clamp(weights.x * distances.x + weights.y * distances.y, 0.0f, 1.0f);
}
