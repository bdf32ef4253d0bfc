// expect: 3:5: conflicting types for 'f'; make the declarations alike
float f(float x);
int f(float x) { return 1; }
float4 t(float2 uv) { return (float4)(uv, 0.0f, 1.0f); }
