// expect: 4:31: implicit conversions between vector types ('float3' (vector of 3 'float' values) and 'int3' (vector of 3 'int' values)) are not permitted; convert it: convert_float3(v), v.xyz, (float4)(v, 1.0f)
float4 t(float x, int n)
{
    float3 v = (float3)(1.0f) * (int3)(1);
    return (float4)(0.0f);
}
