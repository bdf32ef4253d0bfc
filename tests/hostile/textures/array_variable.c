// expect: 4:13: variable length arrays are not supported in OpenCL; give the array a constant length
float4 t(float x, int n)
{
    float a[n];
    return (float4)(0.0f);
}
