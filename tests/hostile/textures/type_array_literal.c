// expect: 4:10: an array without a name; declare a local array
float4 t(float x, int n)
{
    x = ((float[2]){1.0f, 2.0f})[0];
    return (float4)(0.0f);
}
