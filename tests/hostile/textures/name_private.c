// expect: 4:11: 'private' is reserved by OpenCL C; choose another name
float4 t(float x, int n)
{
    float private = x;
    return (float4)(0.0f);
}
