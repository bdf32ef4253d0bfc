// expect: 2:20: attributes are not part of the language: __attribute__ could change what the compiler does; remove it
typedef float wide __attribute__((vector_size(64)));
float4 t(float2 uv) { return (float4)(uv, 0.0f, 1.0f); }
