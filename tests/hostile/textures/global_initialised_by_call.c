// expect: 2:24: initializer element is not a compile-time constant; only constants may stand there
static const float y = sin(1.0f);
float4 t(float2 uv) { return (float4)(uv, 0.0f, 1.0f); }
