// expect: 4:26: cannot assign to variable 'y' with const-qualified type 'const float'; it cannot be changed: copy it to a variable of your own
float4 t(float x, int n)
{
    const float y = x; y = 2.0f;
    return (float4)(0.0f);
}
