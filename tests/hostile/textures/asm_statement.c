// expect: 4:5: assembly runs on one processor only; write it in C
float4 t(float x, int n)
{
    asm("nop");
    return (float4)(0.0f);
}
