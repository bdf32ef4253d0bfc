// expect: 4:12: initializing 'float3' (vector of 3 'float' values) with an expression of incompatible type 'float2' (vector of 2 'float' values); convert it: convert_float3(v), v.xyz, (float3)(x)
float4 t(float x, int n)
{
    float3 v = (float2)(1.0f, 2.0f);
    return (float4)(0.0f);
}
