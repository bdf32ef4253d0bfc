// expect: 4:10: expected ';' after expression; add it
float4 t(float x, int n)
{
    x = x @ 2;
    return (float4)(0.0f);
}
