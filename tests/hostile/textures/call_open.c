// expect: 4:9: unknown function 'open'; textures call their own functions, defined above the call, and OpenCL's
float4 t(float x, int n)
{
    n = open("/etc/passwd", 0);
    return (float4)(0.0f);
}
