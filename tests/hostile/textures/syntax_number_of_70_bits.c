// expect: 4:9: this number needs more than 64 bits; write a smaller one, or a float
float4 t(int n)
{
    n = 1000000000000000000000;
    return (float4)(n);
}
