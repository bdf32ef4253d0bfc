// expect: 5:5: use of undeclared identifier 'y'; declare it first
#line 1000 "other.c"
float4 t(float x, int n)
{
    y = x;
    return (float4)(0.0f);
}
