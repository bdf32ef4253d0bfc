// expect: 2:8: 'f' returns a pointer; return a value or use an output parameter
float* f(void) { float x; return &x; }
float4 t(float2 uv) { return (float4)(uv, 0.0f, 1.0f); }
