// expect: 4:11: 'global' is reserved by OpenCL C; choose another name
float4 t(float x, int n)
{
    float global = x;
    return (float4)(0.0f);
}
