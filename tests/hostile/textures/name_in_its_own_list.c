// expect: 4:23: 'a' is read where its first value is computed; declare it alone (it is then 0), and assign
float4 t(float x)
{
    float a[2] = { x, a[0] };
    return (float4)(a[1]);
}
