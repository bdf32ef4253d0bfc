// expect: 2:7: 'counter' could be written by one path and read by another; make it const, or a local variable
float counter = 0.0f;
float4 t(float2 uv) { return (float4)(uv, 0.0f, 1.0f); }
