// expect: 2:20: 'p' is a pointer; textures have values, arrays by their names, and output parameters only
const float* const p = 0;
float4 t(float2 uv) { return (float4)(uv, 0.0f, 1.0f); }
