// expect: 4:5: goto is not part of the language; use a loop, break, continue or return
float4 t(float x, int n)
{
    again: x += 1.0f; if (x < 3.0f) goto again;
    return (float4)(0.0f);
}
