// expect: 4:12: invalid suffix '.3' on floating constant; correct it to C99 with OpenCL's vectors
float4 t(float x, int n)
{
    x = 1.2.3;
    return (float4)(0.0f);
}
