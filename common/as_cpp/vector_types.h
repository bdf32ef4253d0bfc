// OpenCL's vector types. Included by both C++ dialects (twice by as_double, where `float` is
// widened the second time), hence without a guard.

typedef unsigned int uint;

struct alignas(8) float2 {
    float x, y;
};
struct float3 {
    float x, y, z;
};
struct alignas(16) float4 {
    float x, y, z, w;
};
