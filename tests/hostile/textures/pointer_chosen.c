// expect: 3:59: 'a' is given something else than an array or the address of a local variable; pass one of these
float g(const float* a) { return a[0]; }
float f(const float* a, const float* b, int n) { return g(n ? a : b); }
float4 t(float2 uv) { return (float4)(uv, 0.0f, 1.0f); }
