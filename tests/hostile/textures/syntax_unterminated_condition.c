// expect: 2:2: unterminated conditional directive; end it
#if 1
float4 t(float2 uv) { return (float4)(uv, 0.0f, 1.0f); }
