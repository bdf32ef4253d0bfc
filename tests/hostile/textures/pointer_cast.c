// expect: 4:9: * is for output parameters only; textures have no other pointers
float4 t(float x, int n)
{
    n = *(int*)&x;
    return (float4)(0.0f);
}
