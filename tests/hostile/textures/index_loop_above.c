// expect: 4:47: the index is outside of an array of 3 elements; use 0 to 2
float4 t(float x, int n)
{
    float a[3]; for (int i = 5; i < 9; ++i) a[i] = x;
    return (float4)(0.0f);
}
