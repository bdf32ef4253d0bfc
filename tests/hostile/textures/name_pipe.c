// expect: 4:11: 'pipe' is reserved by OpenCL C; choose another name
float4 t(float x, int n)
{
    float pipe = x;
    return (float4)(0.0f);
}
