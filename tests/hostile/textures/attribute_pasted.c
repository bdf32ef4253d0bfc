// expect: 3:6: '__attri' belongs to the compiler; write it in C99
#define JOIN(a, b) a##b
JOIN(__attri, bute__)((constructor)) void run(void) { }
float4 t(float2 uv) { return (float4)(uv, 0.0f, 1.0f); }
