// expect: 2:1: type specifier missing, defaults to 'int'; correct it to C99 with OpenCL's vectors
f(float x) { return x; }
float4 t(float2 uv) { return (float4)(uv, 0.0f, 1.0f); }
