// expect: 4:38: duplicate case value '1'; correct it to C99 with OpenCL's vectors
float4 t(float x, int n)
{
    switch (n) { case 1: break; case 1: break; }
    return (float4)(0.0f);
}
