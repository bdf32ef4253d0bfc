// expect: 4:16: unknown function 'malloc'; textures call their own functions, defined above the call, and OpenCL's
float4 t(float x, int n)
{
    float* p = malloc(16);
    return (float4)(0.0f);
}
