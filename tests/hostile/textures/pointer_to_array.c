// expect: 4:24: 'p' is a pointer; textures have values, arrays by their names, and output parameters only
float4 t(float x, int n)
{
    float a[3]; float* p = a;
    return (float4)(0.0f);
}
