// expect: 5:22: member reference type 'struct S' is not a pointer; did you mean to use '.'?; correct it to C99 with OpenCL's vectors
struct S { float a; };
float4 t(float x, int n)
{
    struct S s; x = s->a;
    return (float4)(0.0f);
}
