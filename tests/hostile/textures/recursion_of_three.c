// expect: 4:27: recursion: a calls c calls b calls a; GPUs have no call stack, use a loop
float c(float x);
float a(float x) { return c(x); }
float b(float x) { return a(x); }
float c(float x) { return b(x); }
float4 t(float2 uv) { return (float4)(uv, 0.0f, 1.0f); }
