// expect: 2:32: 'a' is assigned another array; assign to *a or to its elements
void f(float* a, float* b) { a = b; *a = 1.0f; }
float4 t(float2 uv) { return (float4)(uv, 0.0f, 1.0f); }
