// expect: 5:10: unknown function '__builtin': compilers' own functions differ; use OpenCL's
#define JOIN(a, b) a##b
float4 t(float x, int n)
{
    JOIN(__builtin, _trap)();
    return (float4)(0.0f);
}
