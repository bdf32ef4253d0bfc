// expect: 4:5: assembly runs on one processor only; write it in C
float4 t(float x, int n)
{
    __asm__ volatile ("int3");
    return (float4)(0.0f);
}
