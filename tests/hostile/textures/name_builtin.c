// expect: 2:7: unknown function '__builtin_mine': compilers' own functions differ; use OpenCL's
float __builtin_mine(float x) { return x; }
float4 t(float2 uv) { return (float4)(uv, 0.0f, 1.0f); }
