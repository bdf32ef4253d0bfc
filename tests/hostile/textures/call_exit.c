// expect: 4:5: unknown function 'exit'; textures call their own functions, defined above the call, and OpenCL's
float4 t(float x, int n)
{
    exit(1);
    return (float4)(0.0f);
}
