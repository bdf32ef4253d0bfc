// expect: 4:31: illegal vector component name 's'; components are x y z w, or s0 to sf
float4 t(float x, int n)
{
    float4 v = x; float2 w = v.xs1;
    return (float4)(0.0f);
}
