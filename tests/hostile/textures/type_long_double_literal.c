// expect: 4:9: this number is not a float; end it with f
float4 t(float x, int n)
{
    x = 1.0L;
    return (float4)(0.0f);
}
