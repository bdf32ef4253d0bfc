// expect: 4:9: unknown function 'saturate'; write clamp(x, 0.0f, 1.0f)
float4 t(float x, int n)
{
    x = saturate(x);
    return (float4)(0.0f);
}
