// The cells of Voronoi's diagram through the object, each of one colour.
// Result: a colour.
//
// scale (float, 1/m, above 0; default 4): cells for each metre of the object
// jitter (float, 0 to 1; default 1): how far the cells' points stray from a grid
// color_a (float3, linear Rec.709; default [0.80, 0.62, 0.38]): one end of the cells' colours
// color_b (float3, linear Rec.709; default [0.10, 0.22, 0.32]): the other end
// shade (float, 0 to 1; default 0.5): how much darker the darkest cells are

float3 voronoi(float scale, float jitter, float3 color_a, float3 color_b, float shade)
{
    const float3 place = readAttr("LocalPos");
    const uint cell = hash_scramble(voronoi3_cell(place * scale, jitter));
    const float2 choice = hash_fractions2(cell);
    return mix(color_a, color_b, choice.x) * (1.0f - shade * choice.y);
}
