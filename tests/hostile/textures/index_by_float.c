// expect: 4:22: array subscript is not an integer; correct it to C99 with OpenCL's vectors
float4 t(float x, int n)
{
    float a[3]; x = a[x];
    return (float4)(0.0f);
}
