// expect: 4:10: 'double' is not available on every device; use float
float4 t(float x, int n)
{
    x = (double)x;
    return (float4)(0.0f);
}
