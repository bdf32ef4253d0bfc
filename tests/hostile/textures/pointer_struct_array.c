// expect: 3:44: the length of 's' is not known; declare it as s[N], or const where it is only read
struct S { float a; };
float f(const struct S* s, int n) { return s[n].a; }
float4 t(float2 uv) { return (float4)(uv, 0.0f, 1.0f); }
