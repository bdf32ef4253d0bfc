// expect: 6:26: 'a' is changed and used here in an order that compilers choose; use a statement for each
float fill(float a[2], float v) { a[1] = v; return v; }
float4 t(float x)
{
    float a[2];
    return (float4)(a[1] + fill(a, x));
}
