// expect: 2:15: the parameter 'p' is a pointer to anything; pass values, arrays of numbers, or an output parameter such as float* out
float f(void* p) { return 1.0f; }
float4 t(float2 uv) { return (float4)(uv, 0.0f, 1.0f); }
