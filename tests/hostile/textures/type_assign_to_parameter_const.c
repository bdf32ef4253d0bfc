// expect: 4:7: cannot assign to variable 'x' with const-qualified type 'const float'; it cannot be changed: copy it to a variable of your own
float4 t(const float x)
{
    x = 1.0f;
    return (float4)(x);
}
