// expect: 5:9: unknown function 'f'; textures call their own functions, defined above the call, and OpenCL's
#define F(...) f(__VA_ARGS__)
float4 t(float x, int n)
{
    x = F(x, x);
    return (float4)(0.0f);
}
