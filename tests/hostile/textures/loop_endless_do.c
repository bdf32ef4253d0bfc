// expect: 4:5: this loop never ends; give it a condition, a break or a return
float4 t(float x, int n)
{
    do { x += 1.0f; } while (2 > 1);
    return (float4)(0.0f);
}
