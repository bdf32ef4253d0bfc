// expect: 4:5: unknown function 'abort'; textures call their own functions, defined above the call, and OpenCL's
float4 t(float x, int n)
{
    abort();
    return (float4)(0.0f);
}
