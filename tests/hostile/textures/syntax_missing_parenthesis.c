// expect: 4:20: expected ')'; add it
float4 t(float x, int n)
{
    float y = sin(x;
    return (float4)(0.0f);
}
