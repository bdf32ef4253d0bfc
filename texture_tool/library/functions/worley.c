// Cellular noise of Worley (1996) over one point in each cell of the unit lattice: the distances
// F1, F2 to the nearest and second nearest point, and which point is nearest.
//
// `jitter` from 0 to 1 is how far points stray from the middles of their cells. Searched are the
// four cells along each axis around the corner nearest to p, so that nothing within 1.5 +
// (1 - jitter)/2 is missed. The nearest point is never farther, and F1 is exact for every jitter up
// to 1; F2 is exact up to a jitter of 0.87 in space and 0.92 in the plane. (Three cells along each
// axis, which many textures search, are exact up to 0.46 and 0.65 only, and leave seams beyond.)

// Where the search begins: the lower corner of the first cell.
float worley_start(float p)
{
    return floor(p - 0.5f) - 1.0f;
}

// From p to the point of cell i among 16 or 64. `first` leads from p to the lower corner of the
// first cell, `h` is the cell's hash.
float2 worley_offset2(float2 first, uint h, int i, float jitter)
{
    const float2 r = hash_fractions2(h);
    const float shift = 0.5f - 0.5f * jitter;
    return make_float2(first.x + (float)(i & 3) + (shift + jitter * r.x),
                       first.y + (float)(i >> 2) + (shift + jitter * r.y));
}

float3 worley_offset3(float3 first, uint h, int i, float jitter)
{
    const float3 r = hash_fractions3(h);
    const float shift = 0.5f - 0.5f * jitter;
    return make_float3(first.x + (float)(i & 3) + (shift + jitter * r.x),
                       first.y + (float)((i >> 2) & 3) + (shift + jitter * r.y),
                       first.z + (float)(i >> 4) + (shift + jitter * r.z));
}

uint worley_hash2(uint start, uint s, int i)
{
    return hash_scramble((start + lattice_sum2(i & 3, i >> 2)) ^ s);
}

uint worley_hash3(uint start, uint s, int i)
{
    return hash_scramble((start + lattice_sum3(i & 3, (i >> 2) & 3, i >> 4)) ^ s);
}

// (F1, F2).
float2 worley2_seeded(float2 p, float jitter, uint seed)
{
    const float2 corner = make_float2(worley_start(p.x), worley_start(p.y));
    const uint start = lattice_sum2((int)corner.x, (int)corner.y);
    const uint s = hash_scramble(seed);
    float f1 = 1.0e30f;
    float f2 = 1.0e30f;
    for (int i = 0; i < 16; ++i) {
        const float2 v = worley_offset2(corner - p, worley_hash2(start, s, i), i, jitter);
        const float d = v.x * v.x + v.y * v.y;
        const float farther = d > f1 ? d : f1;
        f2 = farther < f2 ? farther : f2;
        f1 = d < f1 ? d : f1;
    }
    return make_float2(sqrt(f1), sqrt(f2));
}

float2 worley2(float2 p, float jitter)
{
    return worley2_seeded(p, jitter, 0u);
}

float2 worley3_seeded(float3 p, float jitter, uint seed)
{
    const float3 corner = make_float3(worley_start(p.x), worley_start(p.y), worley_start(p.z));
    const uint start = lattice_sum3((int)corner.x, (int)corner.y, (int)corner.z);
    const uint s = hash_scramble(seed);
    float f1 = 1.0e30f;
    float f2 = 1.0e30f;
    for (int i = 0; i < 64; ++i) {
        const float3 v = worley_offset3(corner - p, worley_hash3(start, s, i), i, jitter);
        const float d = v.x * v.x + v.y * v.y + v.z * v.z;
        const float farther = d > f1 ? d : f1;
        f2 = farther < f2 ? farther : f2;
        f1 = d < f1 ? d : f1;
    }
    return make_float2(sqrt(f1), sqrt(f2));
}

float2 worley3(float3 p, float jitter)
{
    return worley3_seeded(p, jitter, 0u);
}

// Length of a difference; metric 0: Euclid's, 1: sum of the differences, 2: the largest of them.
// (Weights, since a choice on what all paths share keeps loops over paths from vectorising.)
float worley_distance(float3 v, int metric)
{
    const float a = fabs(v.x);
    const float b = fabs(v.y);
    const float c = fabs(v.z);
    const float larger = a > b ? a : b;
    const float largest = larger > c ? larger : c;
    const float euclid = sqrt(a * a + b * b + c * c);
    const float is_sum = (float)(metric == 1);
    const float is_largest = (float)(metric == 2);
    return euclid + is_sum * (a + b + c - euclid) + is_largest * (largest - euclid);
}

// (F1, F2) by a metric: F1 is exact up to a jitter of 0.5 for the sum, of 1 for the largest.
float2 worley3_metric(float3 p, float jitter, int metric, uint seed)
{
    const float3 corner = make_float3(worley_start(p.x), worley_start(p.y), worley_start(p.z));
    const uint start = lattice_sum3((int)corner.x, (int)corner.y, (int)corner.z);
    const uint s = hash_scramble(seed);
    float f1 = 1.0e30f;
    float f2 = 1.0e30f;
    for (int i = 0; i < 64; ++i) {
        const float3 v = worley_offset3(corner - p, worley_hash3(start, s, i), i, jitter);
        const float d = worley_distance(v, metric);
        const float farther = d > f1 ? d : f1;
        f2 = farther < f2 ? farther : f2;
        f1 = d < f1 ? d : f1;
    }
    return make_float2(f1, f2);
}

// The distance from p to the line halfway between the nearest two points: to the border of the cell,
// where it is near.
float voronoi2_border(float2 p, float jitter, uint seed)
{
    const float2 corner = make_float2(worley_start(p.x), worley_start(p.y));
    const uint start = lattice_sum2((int)corner.x, (int)corner.y);
    const uint s = hash_scramble(seed);
    float f1 = 1.0e30f;
    float f2 = 1.0e30f;
    float2 first = make_float2(0.0f, 0.0f);
    float2 second = make_float2(1.0f, 0.0f);
    for (int i = 0; i < 16; ++i) {
        const float2 v = worley_offset2(corner - p, worley_hash2(start, s, i), i, jitter);
        const float d = v.x * v.x + v.y * v.y;
        const int is_first = d < f1;
        const int is_second = d < f2;
        second.x = is_first ? first.x : (is_second ? v.x : second.x);
        second.y = is_first ? first.y : (is_second ? v.y : second.y);
        f2 = is_first ? f1 : (is_second ? d : f2);
        first.x = is_first ? v.x : first.x;
        first.y = is_first ? v.y : first.y;
        f1 = is_first ? d : f1;
    }
    const float2 between = second - first;
    return 0.5f * (f2 - f1) / sqrt(between.x * between.x + between.y * between.y + 1.0e-12f);
}

// A number that belongs to the cell of Voronoi's diagram in which p lies.
uint voronoi2_cell(float2 p, float jitter)
{
    const float2 corner = make_float2(worley_start(p.x), worley_start(p.y));
    const uint start = lattice_sum2((int)corner.x, (int)corner.y);
    const uint s = hash_scramble(0u);
    float nearest = 1.0e30f;
    uint cell = 0u;
    for (int i = 0; i < 16; ++i) {
        const uint h = worley_hash2(start, s, i);
        const float2 v = worley_offset2(corner - p, h, i, jitter);
        const float d = v.x * v.x + v.y * v.y;
        cell = d < nearest ? h : cell;
        nearest = d < nearest ? d : nearest;
    }
    return cell;
}

uint voronoi3_cell(float3 p, float jitter)
{
    const float3 corner = make_float3(worley_start(p.x), worley_start(p.y), worley_start(p.z));
    const uint start = lattice_sum3((int)corner.x, (int)corner.y, (int)corner.z);
    const uint s = hash_scramble(0u);
    float nearest = 1.0e30f;
    uint cell = 0u;
    for (int i = 0; i < 64; ++i) {
        const uint h = worley_hash3(start, s, i);
        const float3 v = worley_offset3(corner - p, h, i, jitter);
        const float d = v.x * v.x + v.y * v.y + v.z * v.z;
        cell = d < nearest ? h : cell;
        nearest = d < nearest ? d : nearest;
    }
    return cell;
}
