// expect: 2:34: * is for output parameters only; textures have no other pointers
float f(const float* a) { return *(a + 1); }
float4 t(float2 uv) { return (float4)(uv, 0.0f, 1.0f); }
