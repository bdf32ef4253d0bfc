// expect: 4:28: sizeof of an array parameter is the size of a pointer; pass the length as another parameter
float4 t(const float* a)
{
    return (float4)((float)sizeof(a));
}
