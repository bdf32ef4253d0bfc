// expect: 2:14: attributes are not part of the language: __attribute__ could change what the compiler does; remove it
#define LATE __attribute__((destructor))
LATE void run(void) { }
float4 t(float2 uv) { return (float4)(uv, 0.0f, 1.0f); }
