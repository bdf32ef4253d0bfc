// expect: 2:21: expected function body after function declarator; correct it to C99 with OpenCL's vectors
float4 t(float2 uv) : COLOR { return (float4)(uv, 0.0f, 1.0f); }
