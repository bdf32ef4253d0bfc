// expect: 5:13: attributes are not part of the language: __attribute__ could change what the compiler does; remove it
void f(float* x) { *x = 0.0f; }
float4 t(float x, int n)
{
    float y __attribute__((cleanup(f)));
    return (float4)(0.0f);
}
