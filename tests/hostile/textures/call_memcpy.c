// expect: 4:14: unknown function 'memcpy'; textures call their own functions, defined above the call, and OpenCL's
float4 t(float x, int n)
{
    float y; memcpy(&y, &x, 4);
    return (float4)(0.0f);
}
