// expect: 2:26: the field 'p' is a pointer; textures have values, arrays by their names, and output parameters only
union U { long n; float* p; };
float4 t(float x, int n)
{
    union U u; u.n = 7; *u.p = 1.0f;
    return (float4)(0.0f);
}
