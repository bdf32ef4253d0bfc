// expect: 4:19: initialisers by index are not C++; list the values in order
float4 t(float x, int n)
{
    float a[3] = {[2] = 1.0f};
    return (float4)(0.0f);
}
