// Vector types with the names and the arithmetic of OpenCL C. Included by both C++ dialects (twice
// by as_double, where `float` is widened the second time), hence without a guard.

typedef unsigned int uint;

struct alignas(2 * sizeof(float)) float2 {
    float x, y;
};
struct float3 {
    float x, y, z;
};
struct alignas(4 * sizeof(float)) float4 {
    float x, y, z, w;
};

SHARED float2 make_float2(float x, float y) { return float2{x, y}; }
SHARED float3 make_float3(float x, float y, float z) { return float3{x, y, z}; }
SHARED float4 make_float4(float x, float y, float z, float w) { return float4{x, y, z, w}; }
SHARED float3 xyz(const float4& v) { return float3{v.x, v.y, v.z}; }

SHARED float2 operator+(float2 a, float2 b) { return {a.x + b.x, a.y + b.y}; }
SHARED float2 operator-(float2 a, float2 b) { return {a.x - b.x, a.y - b.y}; }
SHARED float2 operator*(float2 a, float2 b) { return {a.x * b.x, a.y * b.y}; }
SHARED float2 operator*(float2 a, float s) { return {a.x * s, a.y * s}; }
SHARED float2 operator*(float s, float2 a) { return {s * a.x, s * a.y}; }

SHARED float3 operator-(float3 a) { return {-a.x, -a.y, -a.z}; }
SHARED float3 operator+(float3 a, float3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
SHARED float3 operator-(float3 a, float3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
SHARED float3 operator*(float3 a, float3 b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }
SHARED float3 operator/(float3 a, float3 b) { return {a.x / b.x, a.y / b.y, a.z / b.z}; }
SHARED float3 operator*(float3 a, float s) { return {a.x * s, a.y * s, a.z * s}; }
SHARED float3 operator*(float s, float3 a) { return {s * a.x, s * a.y, s * a.z}; }
SHARED float3 operator/(float3 a, float s) { return {a.x / s, a.y / s, a.z / s}; }

SHARED float4 operator+(float4 a, float4 b) { return {a.x + b.x, a.y + b.y, a.z + b.z, a.w + b.w}; }
SHARED float4 operator-(float4 a, float4 b) { return {a.x - b.x, a.y - b.y, a.z - b.z, a.w - b.w}; }
SHARED float4 operator*(float4 a, float4 b) { return {a.x * b.x, a.y * b.y, a.z * b.z, a.w * b.w}; }
SHARED float4 operator*(float4 a, float s) { return {a.x * s, a.y * s, a.z * s, a.w * s}; }
