// expect: 4:7: assigning to 'float' from incompatible type 'float2' (vector of 2 'float' values); convert it: convert_float3(v), v.xyz, (float3)(x)
float4 t(float x, int n)
{
    x = (float2)(1.0f, 2.0f);
    return (float4)(0.0f);
}
