// expect: 5:7: assigning to 'float' from incompatible type 'void'; convert it: convert_float3(v), v.xyz, (float3)(x)
void f(float x) { x = 1.0f; }
float4 t(float x, int n)
{
    x = f(x);
    return (float4)(0.0f);
}
