// expect: 4:11: 'kernel' is reserved by OpenCL C; choose another name
float4 t(float x, int n)
{
    float kernel = x;
    return (float4)(0.0f);
}
