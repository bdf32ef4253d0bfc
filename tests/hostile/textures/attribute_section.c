// expect: 2:22: attributes are not part of the language: __attribute__ could change what the compiler does; remove it
static const float a __attribute__((section(".init_array"))) = 1.0f;
float4 t(float2 uv) { return (float4)(uv, 0.0f, 1.0f); }
