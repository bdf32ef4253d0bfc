#define final(x) ((x) * 2)
#define mix(a, b) ((a) + (b))
#undef mix
#ifdef FOO
int broken(
#endif
enum Mode { FIRST, SECOND = 4, THIRD };
typedef enum { A1, B1 } Kind;
struct Cell { float2 at; int id; float w[3]; };
union Bits { float f; int i; uint u; };
const float EPS = 1e-3;
static const struct { float a; int b; } rows[2] = { {1, 2}, {3, 4} };
static const float3 palette[] = { {1, 0, 0}, (float3)(0, 1, 0), 0.5 };
float smoothstep(float a, float b, float x) { x = clamp((x - a) / (b - a), 0.0f, 1.0f); return x * x * (3 - 2 * x); }
void split(float x, float *whole, float* part) { *whole = floor(x); *part = x - *whole; }
float exchange(float* old, float by) { float was = *old; *old = by; return was; }
void fill(float out[4], int n) { for (int i = 0; i < n; i++) out[i] = i; }
float nothing(float x) { if (x > 0) return 1; }
struct Cell make(float2 at) { struct Cell c = { at, 3, {1, 2, 3} }; c.w[1] += 2; return c; }
int hash(int n) { n = (n << 13) ^ n; n *= 15731; n += n * n; n -= 3; return n / 3 + n % 7 - -n; }
float bits(float x) { union Bits b; b.f = x; b.i += 1; return b.f; }
enum Mode next(enum Mode m) { switch (m) { case FIRST: return SECOND; case SECOND: { int q = 2; return q; } default: break; } return THIRD; }
float f0() { return 1; }
float4 userProc(float3 class, float PI, int n, uint u)
{
    n = (n >> 22) & 31; u = (u >> 22) & 31;
    float4 v = 1.0f + readAttr("WorldPos").x;
    float2 new = (float2)(u, n);
    v *= 2.0; v += u; v = 2 * v; v = v * n;
    v.xy = v.yx; v.zw += 1; v.s0 = 3; v.x++;
    float w, p; split(v.x, &w, &p); p += exchange(&w, w + 1); w = exchange(&w, p) + p;
    float a[4], z[2][3]; fill(a, 4);
    z[1][n] = a[n & 3]; z[n][2] = 1;
    struct Cell c = make(new), d; d = c;
    int3 cmp = class > (float3)(0.5f);
    float3 s = select(class, (float3)(1, 2, 3), cmp);
    s = cmp ? s : 1;
    s = n > 3 ? s : 0.5f;
    if (any(s < 0.1f) && !all(isnan(s)) || n) s = -s;
    int k = sizeof(a) / sizeof(a[0]), q = convert_int(p) << n;
    k = next(k); k /= n; k <<= n; k %= 3; n -= k; k = hash(k) >> u;
    uint uu = as_uint(v.x) % u; uu = convert_uint_sat(v.y); int2 i2 = convert_int2(v.xy) / n;
    i2 += 1; i2 = i2 * 3 & 7; i2.x++;
    i2 /= n;
    for (float t = 0; t < 1; t += 0.25f) s += t;
    for (int i = 4; i--;) s.x += i;
    int i = 0; do { i++; if (i == 3) continue; } while (i < n);
    for (;;) { if (i++ > 10) break; }
    float fr, si = sincos(w, &fr); float2 fw; float2 fo = fract(v.xy, &fw);
    k = p; k += p; uu = w * 3; char ch = p; ch += 1; short sh = (short)n;
    v[n] = 2; float vv = v[1] + v[n];
    bool yes = n > 2; yes = !yes;
    const int idx[3] = {2, 1, 0};
    float m4 = final(3) + EPS + PI + M_PI + rows[n & 1].a + palette[k].x + palette[idx[i]].y + nothing(p);
    long big = n * 3L; ulong bb = (ulong)u << 3;
    v.lo = v.hi; v.even = v.odd; float8 f8 = 0; f8.s7 = 2; f8.lo = v; v = f8.hi;
    float q1 = (float)n / u, q2 = n ? 1 : 2.5; q1 = fmax(q1, 0), q2 = pow(q2, 2); q1 = max(q1, 0.0f) + min(3, n);
    v = (float4)(v.xy, 0, 0) + (float4)(class, 1) + (float4)(1);
    return v + (float4)(s, bits(1)) + f0() + c.w[k] + z[0][0] + d.at.x + si + fr + fo.x + fw.y + (n, 3) + hypot(1.0f, 2.0f) + q1 + q2 + smoothstep(1, 0, 0.5) + abs(n) + (INFINITY > FLT_MAX) + isnan((float)NAN) + vv + yes + (big & 7) + (bb & 7) + ch + sh + (uu & 255) + m4 + i2.x;
}
