// expect: 2:7: invalid prototype, variadic arguments are not allowed in OpenCL; name each argument
float f(int n, ...) { return 1.0f; }
float4 t(float2 uv) { return (float4)(uv, 0.0f, 1.0f); }
