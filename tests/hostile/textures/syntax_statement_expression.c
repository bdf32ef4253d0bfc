// expect: 4:15: this is an extension of some compilers; write it in C99
float4 t(float x, int n)
{
    float y = ({ float z = x; z; });
    return (float4)(0.0f);
}
