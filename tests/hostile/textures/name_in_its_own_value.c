// expect: 4:15: 'y' is read where its first value is computed; declare it alone (it is then 0), and assign
float4 t(float x)
{
    float y = y + x;
    return (float4)(y);
}
