// expect: 2:9: a parameter list without types is only allowed in a function definition; correct it to C99 with OpenCL's vectors
float f(a, b);
float4 t(float2 uv) { return (float4)(uv, 0.0f, 1.0f); }
