// expect: 5:7: cannot take the address of an rvalue of type 'float'; correct it to C99 with OpenCL's vectors
void f(float* a) { *a = 1.0f; }
float4 t(float x, int n)
{
    f(&1.0f);
    return (float4)(0.0f);
}
