// expect: 4:9: '__alignof__' belongs to the compiler; write it in C99
float4 t(float x, int n)
{
    n = __alignof__(x);
    return (float4)(0.0f);
}
