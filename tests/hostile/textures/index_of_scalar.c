// expect: 4:10: subscripted value is not an array, pointer, or vector; correct it to C99 with OpenCL's vectors
float4 t(float x, int n)
{
    x = x[0];
    return (float4)(0.0f);
}
