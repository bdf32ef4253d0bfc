// expect: 4:15: * is for output parameters only; textures have no other pointers
float4 t(float x, int n)
{
    float y = *(float*)0x1234;
    return (float4)(0.0f);
}
