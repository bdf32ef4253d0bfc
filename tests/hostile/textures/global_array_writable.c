// expect: 2:7: 'memory' could be written by one path and read by another; make it const, or a local variable
float memory[16];
float4 t(float2 uv) { return (float4)(uv, 0.0f, 1.0f); }
