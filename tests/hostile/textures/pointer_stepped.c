// expect: 2:28: arithmetic with pointers and arrays; use an index: name[i]
float f(const float* a) { a++; return *a; }
float4 t(float2 uv) { return (float4)(uv, 0.0f, 1.0f); }
