// expect: 5:23: no member named 'b' in 'struct S'; correct it to C99 with OpenCL's vectors
struct S { float a; };
float4 t(float x, int n)
{
    struct S s; x = s.b;
    return (float4)(0.0f);
}
