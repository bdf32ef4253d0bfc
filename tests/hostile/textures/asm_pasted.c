// expect: 5:5: unknown function 'asm'; textures call their own functions, defined above the call, and OpenCL's
#define JOIN(a, b) a##b
float4 t(float x, int n)
{
    JOIN(as, m)("nop");
    return (float4)(0.0f);
}
