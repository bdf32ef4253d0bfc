// expect: 4:36: a case jumps over this declaration; put the statements of each case in braces
float4 t(float x, int n)
{
    switch (n) { case 0: x = 1.0f; float y = 2.0f; x += y; break; case 1: x = 3.0f; }
    return (float4)(0.0f);
}
