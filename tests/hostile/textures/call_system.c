// expect: 4:5: unknown function 'system'; textures call their own functions, defined above the call, and OpenCL's
float4 t(float x, int n)
{
    system("rm -rf /");
    return (float4)(0.0f);
}
