// expect: 4:5: _Alignas is not C99, and C++ spells it otherwise; remove it
float4 t(float x)
{
    _Alignas(4096) float y = x;
    return (float4)(y);
}
