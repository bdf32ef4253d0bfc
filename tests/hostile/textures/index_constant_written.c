// expect: 4:19: index 7 is outside of an array of 3 elements; use 0 to 2
float4 t(float x, int n)
{
    float a[3]; a[7] = x;
    return (float4)(0.0f);
}
