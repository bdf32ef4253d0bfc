// What C leaves open has one result: division by zero, wide shifts, overflow, conversions out of
// range, uninitialised variables, indexes outside, loops without end, a missing return.
struct Pair { int a; float3 b; };
static const int table[4] = {1, 2, 3, 4};

int missing(int x) { if (x > 1000) return 5; }

int at(const int* list, int i) { return list[i]; }

float4 defined(float scale)
{
    float3 p = readAttr("WorldPos");
    int n = (int)(p.x * 1e9f), zero = (int)(p.y * 0.0f);
    int low = -2147483647 - 1;
    int garbage;
    float3 nothing;
    struct Pair pair;
    float list[5];
    int sum = garbage + pair.a + (int)list[n & 3] + (int)nothing.y + (int)pair.b.z;
    sum += n / zero + n % zero + (low + zero) / (zero - 1) + (low + zero) % (zero - 1);
    sum ^= (n << (n & 127)) ^ (n >> (zero + 33)) ^ (n * n * 15731 + 789221);
    sum += table[n] + at(table, -n) + missing(n);
    sum ^= (1 << -1) ^ (n << -1) ^ (7 >> 33) ^ (low / -1) ^ (low % -1);
    n++; n += n; n *= n; n -= 7; n = -n; n /= zero; --n;
    uint u = (uint)(p.z * -5.0f) + (uint)1e20f + 7u / (uint)zero;
    int spins = 0;
    while (spins >= 0) { spins = (spins + 1) & 1023; }
    int2 pairs = (int2)(n, low) / (int2)(zero, -1);
    float s = smoothstep(1.0f, 0.0f, p.x) + smoothstep(0.5f, 0.5f, p.y);
    int3 far = convert_int3(p * 1e30f);
    return (float4)((float)sum, (float)(u & 0xffffffu) + s, (float)(spins + pairs.x + pairs.y), (float)(far.x ^ far.y) + (float)n * scale);
}
