// expect: 4:5: unknown function '__builtin_trap': compilers' own functions differ; use OpenCL's
float4 t(float x, int n)
{
    __builtin_trap();
    return (float4)(0.0f);
}
