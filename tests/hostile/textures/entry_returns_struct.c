// expect: 3:10: the texture 't' returns no colour; let it return float, float2, float3 or float4
struct S { float4 c; };
struct S t(float x) { struct S s; return s; }
