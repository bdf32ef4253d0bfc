// expect: 4:29: index 3 is outside of an array of 3 elements; use 0 to 2
float4 t(float x, int n)
{
    float a[2][3]; x = a[1][3];
    return (float4)(0.0f);
}
