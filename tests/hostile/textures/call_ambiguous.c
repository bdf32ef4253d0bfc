// expect: 4:9: call to 'max' is ambiguous; give the arguments the same type, as in max(0.0f, x)
float4 t(float x, int n)
{
    x = max(n, x);
    return (float4)(0.0f);
}
