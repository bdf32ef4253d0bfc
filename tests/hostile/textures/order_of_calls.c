// expect: 5:31: 'x' is changed and used here in an order that compilers choose; use a statement for each
float step_up(float* by) { *by += 1.0f; return *by; }
float4 t(float x)
{
    float y = step_up(&x) + x * step_up(&x);
    return (float4)(y);
}
