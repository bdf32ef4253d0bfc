// expect: 5:10: taking address of function is not allowed; correct it to C99 with OpenCL's vectors
float f(float a) { return a; }
float4 t(float x, int n)
{
    x = (f)(x);
    return (float4)(0.0f);
}
