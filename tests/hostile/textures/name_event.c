// expect: 2:8: 'event_t' is reserved by OpenCL C; choose another name
struct event_t { float a; };
float4 t(float2 uv) { return (float4)(uv, 0.0f, 1.0f); }
