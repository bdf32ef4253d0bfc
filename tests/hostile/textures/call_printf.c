// expect: 4:5: unknown function 'printf'; textures call their own functions, defined above the call, and OpenCL's
float4 t(float x, int n)
{
    printf("%f", x);
    return (float4)(0.0f);
}
