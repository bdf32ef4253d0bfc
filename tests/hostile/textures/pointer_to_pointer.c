// expect: 2:17: the parameter 'p' is a pointer to another; pass values, arrays of numbers, or an output parameter such as float* out
float f(float** p) { return **p; }
float4 t(float2 uv) { return (float4)(uv, 0.0f, 1.0f); }
