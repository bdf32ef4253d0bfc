// expect: 4:9: unknown function '__builtin_sinf': compilers' own functions differ; use OpenCL's
float4 t(float x, int n)
{
    x = __builtin_sinf(x);
    return (float4)(0.0f);
}
