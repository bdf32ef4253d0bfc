// expect: 4:12: recursion: t calls t; GPUs have no call stack, use a loop
float4 t(float x)
{
    return t(x);
}
