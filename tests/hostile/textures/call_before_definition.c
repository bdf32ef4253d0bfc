// expect: 4:9: unknown function 'later'; textures call their own functions, defined above the call, and OpenCL's
float4 t(float x, int n)
{
    x = later(x);
    return (float4)(0.0f);
}
float later(float x) { return x; }
