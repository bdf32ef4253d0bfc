// expect: 2:2: not for you; correct it to C99 with OpenCL's vectors
#error not for you
float4 t(float2 uv) { return (float4)(uv, 0.0f, 1.0f); }
