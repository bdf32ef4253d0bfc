// expect: 4:9: unknown function 'rand'; textures call their own functions, defined above the call, and OpenCL's
float4 t(float x, int n)
{
    n = rand();
    return (float4)(0.0f);
}
