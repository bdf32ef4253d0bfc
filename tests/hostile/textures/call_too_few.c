// expect: 4:9: no matching function for call to 'mix'; check the number and types of the arguments
float4 t(float x, int n)
{
    x = mix(x, 1.0f);
    return (float4)(0.0f);
}
