// expect: 4:11: expected ';' after expression; add it
float4 t(float x, int n)
{
    float5 v;
    return (float4)(0.0f);
}
