// expect: 4:5: 'double' is not available on every device; use float
float4 t(float x, int n)
{
    double d = x;
    return (float4)(0.0f);
}
