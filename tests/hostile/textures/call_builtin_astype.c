// expect: 4:9: unknown function '__builtin_astype': compilers' own functions differ; use OpenCL's
float4 t(float x, int n)
{
    n = __builtin_astype(x, int);
    return (float4)(0.0f);
}
