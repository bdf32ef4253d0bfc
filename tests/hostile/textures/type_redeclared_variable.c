// expect: 4:24: redefinition of 'y'; give one of them another name
float4 t(float x, int n)
{
    float y = x; float y = 2.0f;
    return (float4)(0.0f);
}
