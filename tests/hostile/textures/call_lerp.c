// expect: 4:9: unknown function 'lerp'; OpenCL calls it mix
float4 t(float x, int n)
{
    x = lerp(x, 1.0f, 0.5f);
    return (float4)(0.0f);
}
