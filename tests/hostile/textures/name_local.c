// expect: 4:11: 'local' is reserved by OpenCL C; choose another name
float4 t(float x, int n)
{
    float local = x;
    return (float4)(0.0f);
}
