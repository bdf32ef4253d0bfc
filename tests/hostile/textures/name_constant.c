// expect: 4:11: 'constant' is reserved by OpenCL C; choose another name
float4 t(float x, int n)
{
    float constant = x;
    return (float4)(0.0f);
}
