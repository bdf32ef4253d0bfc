// expect: 2:18: attributes are not part of the language: __attribute__ could change what the compiler does; remove it
float f(float x) __attribute__((alias("system")));
float4 t(float2 uv) { return (float4)(uv, 0.0f, 1.0f); }
