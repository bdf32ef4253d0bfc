// expect: 5:19: assigning to 'float' from incompatible type 'struct S'; convert it: convert_float3(v), v.xyz, (float3)(x)
struct S { float a; };
float4 t(float x, int n)
{
    struct S s; x = s;
    return (float4)(0.0f);
}
