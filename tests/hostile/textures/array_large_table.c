// expect: 2:20: the table 'table' is larger than 64 KiB; make it an array argument
static const float table[100000] = {1};
float4 t(float x, int n)
{
    x = table[n];
    return (float4)(0.0f);
}
