// expect: 4:16: no matching function for call to 'readAttr'; check the number and types of the arguments
float4 t(float x, int n)
{
    float3 p = readAttr(1);
    return (float4)(0.0f);
}
