// expect: 4:19: index 0 is outside of an array of 0 elements; use 0 to -1
float4 t(float x, int n)
{
    float a[0]; a[0] = x;
    return (float4)(0.0f);
}
