// expect: 4:10: multiple unsequenced modifications to 'n'; compilers take them in different orders: use a statement for each
float4 t(int n)
{
    n = n++ + ++n;
    return (float4)(n);
}
