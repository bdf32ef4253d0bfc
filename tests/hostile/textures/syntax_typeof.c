// expect: 4:5: '__typeof__' belongs to the compiler; write it in C99
float4 t(float x, int n)
{
    __typeof__(x) y = x;
    return (float4)(0.0f);
}
