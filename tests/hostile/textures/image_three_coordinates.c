// expect: 4:21: passing 'float3' (vector of 3 'float' values) to parameter of incompatible type 'float2' (vector of 2 'float' values); convert it: convert_float3(v), v.xyz, (float3)(x)
float4 t(sam2D a)
{
    return tex2D(a, (float3)(0.0f));
}
