// expect: 2:20: the constant 'seed' has no value here; give it one
extern const float seed;
float4 t(float2 uv) { return (float4)(uv, 0.0f, 1.0f); }
