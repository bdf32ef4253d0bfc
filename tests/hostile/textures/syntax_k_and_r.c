// expect: 2:7: 'f' is defined in the style before C89; write the types inside the parentheses
float f(x) float x; { return x; }
float4 t(float2 uv) { return (float4)(uv, 0.0f, 1.0f); }
