// expect: 4:9: OpenCL's fract(x, &whole) takes an address too; write x - floor(x)
float4 t(float x, int n)
{
    x = fract(x);
    return (float4)(0.0f);
}
