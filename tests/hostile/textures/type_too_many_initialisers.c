// expect: 4:31: excess elements in array initializer; correct it to C99 with OpenCL's vectors
float4 t(float x, int n)
{
    float a[2] = {1.0f, 2.0f, 3.0f};
    return (float4)(0.0f);
}
