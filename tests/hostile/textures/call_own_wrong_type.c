// expect: 5:11: passing 'float3' (vector of 3 'float' values) to parameter of incompatible type 'float2' (vector of 2 'float' values); convert it: convert_float3(v), v.xyz, (float3)(x)
float f(float2 a) { return a.x; }
float4 t(float x, int n)
{
    x = f((float3)(x));
    return (float4)(0.0f);
}
