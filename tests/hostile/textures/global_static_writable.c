// expect: 2:12: 'counter' could be written by one path and read by another; make it const, or a local variable
static int counter;
float4 t(float2 uv) { return (float4)(uv, 0.0f, 1.0f); }
