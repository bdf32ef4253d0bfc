// expect: 4:5: no matching function for call to 'atomic_add'; check the number and types of the arguments
float4 t(float x, int n)
{
    atomic_add(&n, 1);
    return (float4)(0.0f);
}
