// expect: 3:7: redefinition of 'f'; give one of them another name
float f(float x) { return x; }
float f(float x) { return x; }
float4 t(float2 uv) { return (float4)(uv, 0.0f, 1.0f); }
