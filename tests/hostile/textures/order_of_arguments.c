// expect: 5:35: multiple unsequenced modifications to 'n'; compilers take them in different orders: use a statement for each
int both(int a, int b) { return a + 10 * b; }
float4 t(int n)
{
    return (float4)((float)(both(n++, n++)));
}
