// expect: 4:24: several tables in one declaration; declare each by itself
float4 t(float x, int n)
{
    static const float a[1] = {1}, b[1] = {2}; x = a[0] + b[0];
    return (float4)(0.0f);
}
