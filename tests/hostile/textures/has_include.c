// expect: 2:5: __has_include asks about one compiler; remove it
#if __has_include("/etc/passwd")
#endif
float4 t(float2 uv) { return (float4)(uv, 0.0f, 1.0f); }
