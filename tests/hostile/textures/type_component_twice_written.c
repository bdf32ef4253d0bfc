// expect: 4:24: vector is not assignable (contains duplicate components); assign to a variable
float4 t(float x, int n)
{
    float3 v = x; v.xx = (float2)(1.0f);
    return (float4)(0.0f);
}
