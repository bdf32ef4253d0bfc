// expect: 2:27: the length of 'a' is not known; declare it as a[N], or const where it is only read
void f(float* a, int n) { a[n] = 1.0f; }
float4 t(float2 uv) { return (float4)(uv, 0.0f, 1.0f); }
