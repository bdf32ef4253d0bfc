// expect: 4:18: passing 'const float *' to parameter of incompatible type 'sam2D' (aka 'struct sam2D_'); convert it: convert_float3(v), v.xyz, (float3)(x)
float4 t(const float* a)
{
    return tex2D(a, (float2)(0.0f));
}
