// Accepted, and does whatever a stranger's texture may try: the host must stay whole, and every
// backend must give the same.
static const int table[4] = {3, -1, 4, 1};

typedef struct {
    float at[3];
    int count;
} Record;

int pick(const int* from, int k) { return from[k]; }

void fill(float* out, float v) { *out = v; }

float4 misbehaving(int k, const float* values, const float3* vectors, uint n, float x)
{
    const float3 place = readAttr("WorldPos");
    const int wild = (int)(place.x * 1e9f) + k;  // far outside of int, and of every array
    Record records[2];
    float own[5];
    float sum = values[wild] + values[-wild] + vectors[wild ^ 0x7fffffff].y + (float)table[wild];
    own[wild] = 1.0f;
    own[-1 - wild] += 2.0f;
    records[wild >> 3].at[wild] = 3.0f;
    records[wild].count = pick(table, wild) + pick(table, -2000000000);
    sum += records[1].at[2] + records[0].at[0] + (float)(records[0].count + records[1].count);

    const int lowest = -2147483647 - 1;
    const int divided = lowest / (wild - wild - 1) + wild / (k - k) + lowest % -(1 + k - k);
    const uint shifted = (n << (wild | 32)) + (n >> wild) + (uint)(lowest >> (k + 1000));
    const int converted = (int)(place.y * 1e20f) + convert_int_sat(place.x * 1e30f);
    sum += (float)(divided & 255) + (float)(shifted & 255u) + (float)(converted & 255);

    for (float f = 1.0f; f < 2.0f; f *= 1.0f) sum += 0.001f;
    while (sum > -1.0f) sum = fabs(sum);
    float out = 0.0f;
    fill(&out, own[0] + own[4] + sqrt(-1.0f - x * x) * 0.0f);
    return to_float4(make_float3(sum, out, x / (x - x)), (float)(wild & 3));
}
