// expect: 2:17: C does not support default arguments; correct it to C99 with OpenCL's vectors
float f(float x = 1.0f) { return x; }
float4 t(float2 uv) { return (float4)(uv, 0.0f, 1.0f); }
