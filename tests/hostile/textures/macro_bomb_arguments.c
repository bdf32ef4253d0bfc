// expect: 1:1: reading this file took more than 1 GiB or broke the parser; make it simpler
#define D(x) (x) + (x)
float4 t(float x, int n)
{
    x = D(D(D(D(D(D(D(D(D(D(D(D(D(D(D(D(D(D(D(D(D(D(D(D(D(D(D(D(D(D(x))))))))))))))))))))))))))))));
    return (float4)(0.0f);
}
