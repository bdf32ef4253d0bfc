// expect: 6:7: passing 'const float *' to parameter of type 'float *' changes address space of pointer; correct it to C99 with OpenCL's vectors
void f(float a[2]) { a[0] = 1.0f; }
static const float table[2] = {1, 2};
float4 t(float x, int n)
{
    f(table);
    return (float4)(0.0f);
}
