// expect: 5:15: 'k' is declared in the loop's head already; give one of them another name
float4 t(float x, int n)
{
    for (int k = 0; k < n; k++) {
        float k = 0.5f;
        x += k;
    }
    return (float4)(x);
}
