// expect: 3:1: extraneous closing brace ('}'); correct it to C99 with OpenCL's vectors
float4 t(float2 uv) { return (float4)(uv, 0.0f, 1.0f); }
}
