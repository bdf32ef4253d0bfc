// expect: 5:14: variable has incomplete type 'struct S'; correct it to C99 with OpenCL's vectors
struct S;
float4 t(float x, int n)
{
    struct S s;
    return (float4)(0.0f);
}
