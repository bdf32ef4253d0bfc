// expect: 3:27: recursion: f calls f; GPUs have no call stack, use a loop
#define AGAIN f(x)
float f(float x) { return AGAIN; }
float4 t(float2 uv) { return (float4)(uv, 0.0f, 1.0f); }
