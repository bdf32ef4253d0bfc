// expect: 4:11: 'größe' is not a name that every compiler takes; use the letters a to z, digits and _
float4 t(float x, int n)
{
    float größe = x;
    return (float4)(0.0f);
}
