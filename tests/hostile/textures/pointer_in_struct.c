// expect: 2:19: the field 'p' is a pointer; textures have values, arrays by their names, and output parameters only
struct S { float* p; };
float4 t(float2 uv) { return (float4)(uv, 0.0f, 1.0f); }
