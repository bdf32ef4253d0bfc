// expect: 5:15: index 4 is outside of an array of 4 elements; use 0 to 3
static const float table[4] = {1, 2, 3, 4};
float4 t(float x, int n)
{
    x = table[4];
    return (float4)(0.0f);
}
