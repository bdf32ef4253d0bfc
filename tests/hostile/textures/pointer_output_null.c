// expect: 5:7: 'a' is given something else than an array or the address of a local variable; pass one of these
void f(float* a) { *a = 1.0f; }
float4 t(float x, int n)
{
    f(0);
    return (float4)(0.0f);
}
