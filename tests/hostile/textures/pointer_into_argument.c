// expect: 5:23: 'a' needs the address of a local variable of the caller's; declare one and pass it
float f(const float* a) { return a[0]; }
float4 t(const float* a)
{
    return (float4)(f(&a[2]));
}
