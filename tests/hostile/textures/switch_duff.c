// expect: 4:42: this case jumps into a block; put it directly inside the switch
float4 t(float x, int n)
{
    switch (n) { case 0: do { x += 1.0f; case 1: x += 2.0f; } while (--n > 0); }
    return (float4)(0.0f);
}
