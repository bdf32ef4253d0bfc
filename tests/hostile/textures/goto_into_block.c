// expect: 4:5: goto is not part of the language; use a loop, break, continue or return
float4 t(float x, int n)
{
    goto inside; { inside: x = 1.0f; }
    return (float4)(0.0f);
}
