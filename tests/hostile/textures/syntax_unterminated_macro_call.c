// expect: 5:15: unterminated function-like macro invocation; end it
#define F(x) x
float4 t(float x, int n)
{
    float y = F(x;
    return (float4)(0.0f);
}
