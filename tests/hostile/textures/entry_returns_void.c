// expect: 2:6: the texture 't' returns no colour; let it return float, float2, float3 or float4
void t(float x) { x = 1.0f; }
