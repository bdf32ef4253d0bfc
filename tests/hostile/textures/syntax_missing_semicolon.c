// expect: 4:16: expected ';' at end of declaration; add it
float4 t(float x, int n)
{
    float y = x
    return (float4)(0.0f);
}
