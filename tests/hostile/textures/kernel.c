// expect: 2:1: '__kernel' is reserved by OpenCL C; choose another name
__kernel void run(__global float* a) { a[0] = 1.0f; }
float4 t(float2 uv) { return (float4)(uv, 0.0f, 1.0f); }
