// expect: 4:10: variable has incomplete type 'void'; correct it to C99 with OpenCL's vectors
float4 t(float x, int n)
{
    void v;
    return (float4)(0.0f);
}
