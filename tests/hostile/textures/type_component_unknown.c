// expect: 4:24: illegal vector component name 'q'; components are x y z w, or s0 to sf
float4 t(float x, int n)
{
    float3 v = x; x = v.q;
    return (float4)(0.0f);
}
