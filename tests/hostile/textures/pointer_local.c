// expect: 4:12: 'p' is a pointer; textures have values, arrays by their names, and output parameters only
float4 t(float x, int n)
{
    float* p = &x;
    return (float4)(0.0f);
}
