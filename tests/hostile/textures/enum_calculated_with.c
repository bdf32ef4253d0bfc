// expect: 6:7: an enum is calculated with; use an int
enum Mode { PLAIN, FANCY };
float4 t(int n)
{
    enum Mode m = PLAIN;
    m |= n;
    return (float4)(m);
}
