// expect: 2:1: assembly runs on one processor only; write it in C
asm(".globl evil");
float4 t(float2 uv) { return (float4)(uv, 0.0f, 1.0f); }
