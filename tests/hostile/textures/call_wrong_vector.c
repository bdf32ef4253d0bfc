// expect: 4:9: no matching function for call to 'dot'; check the number and types of the arguments
float4 t(float x, int n)
{
    x = dot((float3)(x), (float2)(x));
    return (float4)(0.0f);
}
