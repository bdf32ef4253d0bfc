// expect: 2:18: assembly runs on one processor only; write it in C
float f(float x) __asm__("system");
float4 t(float2 uv) { return (float4)(uv, 0.0f, 1.0f); }
