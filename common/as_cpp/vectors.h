// The arithmetic of OpenCL C on the types of vector_types.h.

SHARED float2 make_float2(float x, float y) { return float2{x, y}; }
SHARED float3 make_float3(float x, float y, float z) { return float3{x, y, z}; }
SHARED float4 make_float4(float x, float y, float z, float w) { return float4{x, y, z, w}; }
SHARED float3 xyz(float4 v) { return float3{v.x, v.y, v.z}; }

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
