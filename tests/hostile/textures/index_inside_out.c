// expect: 4:21: the array stands inside the brackets; write array[index]
float4 t(float x, int n)
{
    float a[3]; x = 1[a];
    return (float4)(0.0f);
}
