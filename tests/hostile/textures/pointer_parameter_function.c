// expect: 2:16: pointers to functions are not allowed; GPUs have none: call the function by its name
float f(float (*g)(float)) { return g(1.0f); }
float4 t(float2 uv) { return (float4)(uv, 0.0f, 1.0f); }
