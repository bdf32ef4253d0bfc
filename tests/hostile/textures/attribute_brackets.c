// expect: 2:2: expected expression; correct it to C99 with OpenCL's vectors
[[gnu::constructor]] void run(void) { }
float4 t(float2 uv) { return (float4)(uv, 0.0f, 1.0f); }
