// expect: 2:14: expected ')'; add it
float f(float& x) { return x; }
float4 t(float2 uv) { return (float4)(uv, 0.0f, 1.0f); }
