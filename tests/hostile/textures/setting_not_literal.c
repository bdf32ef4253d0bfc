// expect: 4:9: no matching function for call to 'readSetting'; check the number and types of the arguments
float4 t(float x, int n)
{
    x = readSetting(n);
    return (float4)(0.0f);
}
