// expect: 2:27: redefinition of 'a'; give one of them another name
static const float a = 1, a = 2;
float4 t(float2 uv) { return (float4)(uv, 0.0f, 1.0f); }
