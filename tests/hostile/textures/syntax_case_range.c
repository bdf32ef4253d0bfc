// expect: 4:18: a range of cases is not C99; write each case
float4 t(float x, int n)
{
    switch (n) { case 1 ... 3: break; }
    return (float4)(0.0f);
}
