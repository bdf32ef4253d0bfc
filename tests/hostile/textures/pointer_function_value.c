// expect: 5:10: taking address of function is not allowed; correct it to C99 with OpenCL's vectors
float g(float x) { return x; }
float4 t(float x, int n)
{
    n = (g != 0);
    return (float4)(0.0f);
}
