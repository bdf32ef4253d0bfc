// expect: 4:22: 'abs' is there for float, int and uint, not for short; convert the arguments
float4 t(float x, int n)
{
    short s = 1; s = abs(s);
    return (float4)(0.0f);
}
