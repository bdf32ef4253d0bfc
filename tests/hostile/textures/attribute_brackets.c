// expect: 2:1: attributes and digraphs are not part of the language: [[ could change what the compiler does; remove it
[[gnu::constructor]] void run(void) { }
float4 t(float2 uv) { return (float4)(uv, 0.0f, 1.0f); }
