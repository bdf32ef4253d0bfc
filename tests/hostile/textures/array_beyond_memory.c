// expect: 4:13: array is too large (1000000000000000000 elements); make it an array argument
float4 t(float x, int n)
{
    float a[1000000000000000000];
    return (float4)(0.0f);
}
