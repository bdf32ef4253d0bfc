// expect: 5:12: too few arguments to function call, expected 2, have 1; give every argument
float f(float a, float b) { return a + b; }
float4 t(float x, int n)
{
    x = f(x);
    return (float4)(0.0f);
}
