// expect: 4:23: this operator may divide by zero or shift too far in a type that is not int or uint; convert the operands to int
float4 t(float x, int n)
{
    long q = n; q = q / n;
    return (float4)(0.0f);
}
