// expect: 4:14: a cast to or from a pointer; use as_uint and as_float for the bits of a number
float4 t(float x, int n)
{
    long q = (long)&x;
    return (float4)(0.0f);
}
