// expect: 4:5: 'half' is reserved by OpenCL C; choose another name
float4 t(float x, int n)
{
    half h = x;
    return (float4)(0.0f);
}
