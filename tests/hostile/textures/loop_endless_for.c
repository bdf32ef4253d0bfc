// expect: 4:5: this loop never ends; give it a condition, a break or a return
float4 t(float x, int n)
{
    for (;;) x += 1.0f;
    return (float4)(0.0f);
}
