// Value noise with everything.
#define OCTAVES 5
#define SQR(x) ((x) * (x))
typedef struct { float value; float3 slope; } Sample;
static const int table[16] = {3, 1, 4, 1, 5, 9, 2, 6, 5, 3, 5, 8, 9, 7, 9, 3};
float hash(int x, int y, int z)
{
    int n = x + y * 57 + z * 131;
    n = (n << 13) ^ n;
    return 1.0 - ((n * (n * n * 15731 + 789221) + 1376312589) & 0x7fffffff) / 1073741824.0;
}
float pick(const float* ramp, int count, float t) { return ramp[(int)(t * (count - 1))]; }
static float noise(float3 p)
{
    int x = floor(p.x), y = (int)floor(p.y), z = (int)floor(p.z);
    float3 f = p - floor(p);
    f = f * f * (3.0 - 2.0 * f);
    float c[8];
    for (int i = 0; i < 8; i++)
        c[i] = hash(x + (i & 1), y + ((i >> 1) & 1), z + (i >> 2));
    float a = mix(mix(c[0], c[1], f.x), mix(c[2], c[3], f.x), f.y);
    float b = mix(mix(c[4], c[5], f.x), mix(c[6], c[7], f.x), f.y);
    return mix(a, b, f.z);
}
Sample fbm(float3 p, float gain, int *steps) {
    Sample s;
    float w = 1;
    for (int i = 0; i < OCTAVES; i++) { s.value += w * noise(p); p *= 2; w *= gain; *steps += 1; }
    s.slope.xy = p.zx; s.slope.z = SQR(w);
    return s;
}
float4 userProc(float3 color, const float* ramp, float scale, sam2D img, uint n)
{
    static const float3 tint[2] = { (float3)(1, 0.5, 0.25), {0.5, 1, 0.25} };
    int steps = 0;
    float3 p = readAttr("WorldPos") * scale;
    Sample s = fbm(p, 0.5, &steps);
    float acc = 0;
    for (uint i = 0; i < n; i++) acc += s.value / (i + 1);
    while (acc > 1) acc *= 0.5f;
    int k = table[steps] % (int)n;
    float own[3] = {0, 0.5, 1};
    float r = pick(ramp, 4, acc) + pick(own, 3, acc);
    float3 c = color * r + tint[k];
    c = c > 0.5f ? c : (float3)(0.1f);
    c.xy *= 0.5;
    c += tex2D(img, c.xy).xyz;
    return (float4)(c, readOcclusion("upper", scale));
}
