// expect: 2:16: bit-fields are not supported in OpenCL; correct it to C99 with OpenCL's vectors
struct S { int a : 3; };
float4 t(float2 uv) { return (float4)(uv, 0.0f, 1.0f); }
