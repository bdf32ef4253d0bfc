// expect: 4:23: index -1 is outside of an array of 3 elements; use 0 to 2
float4 t(float x, int n)
{
    float a[3]; x = a[-1];
    return (float4)(0.0f);
}
