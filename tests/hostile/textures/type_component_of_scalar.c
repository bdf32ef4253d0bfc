// expect: 4:10: member reference base type 'float' is not a structure or union; correct it to C99 with OpenCL's vectors
float4 t(float x, int n)
{
    x = x.x;
    return (float4)(0.0f);
}
