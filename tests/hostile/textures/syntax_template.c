// expect: 2:1: unknown type name 'template'; textures have C's and OpenCL's types, sam2D and their own
template<class T> T twice(T x) { return x + x; }
float4 t(float2 uv) { return (float4)(uv, 0.0f, 1.0f); }
