// expect: 6:20: 'seed' is changed and used here in an order that compilers choose; use a statement for each
float next(int* seed) { *seed = *seed * 1103515245 + 12345; return *seed; }
float4 t(int n)
{
    int seed = n;
    return (float4)(next(&seed), next(&seed), next(&seed), 1.0f);
}
