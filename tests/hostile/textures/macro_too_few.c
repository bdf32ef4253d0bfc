// expect: 5:12: too few arguments provided to function-like macro invocation; give every argument
#define F(a, b) a + b
float4 t(float x, int n)
{
    x = F(x);
    return (float4)(0.0f);
}
