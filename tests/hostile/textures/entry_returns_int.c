// expect: 2:5: the texture 't' returns no colour; let it return float, float2, float3 or float4
int t(float x) { return 1; }
