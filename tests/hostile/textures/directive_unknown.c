// expect: 2:1: #frobnicate is not part of the language; remove it
#frobnicate
float4 t(float2 uv) { return (float4)(uv, 0.0f, 1.0f); }
