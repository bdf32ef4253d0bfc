// expect: 2:13: the constant 'seed' has no value here; give it one
const float seed;
float4 t(float2 uv) { return (float4)(uv, 0.0f, 1.0f); }
