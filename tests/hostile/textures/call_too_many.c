// expect: 4:9: no matching function for call to 'sin'; check the number and types of the arguments
float4 t(float x, int n)
{
    x = sin(x, x);
    return (float4)(0.0f);
}
