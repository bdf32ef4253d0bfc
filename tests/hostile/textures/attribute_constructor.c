// expect: 2:1: attributes are not part of the language: __attribute__ could change what the compiler does; remove it
__attribute__((constructor)) void run(void) { }
float4 t(float2 uv) { return (float4)(uv, 0.0f, 1.0f); }
