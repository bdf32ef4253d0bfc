// expect: 4:24: expected '}'; add it
float4 t(float x)
{
    return (float4)(x);
