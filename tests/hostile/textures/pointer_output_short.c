// expect: 5:19: 'a' has 4 elements and this array only 2; pass a longer one
void f(float a[4]) { a[3] = 1.0f; }
float4 t(float x, int n)
{
    float b[2]; f(b);
    return (float4)(0.0f);
}
