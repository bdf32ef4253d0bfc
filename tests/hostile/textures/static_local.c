// expect: 4:16: 'calls' would keep its value between paths; make it static const with a value, or drop the word static
float4 t(float x, int n)
{
    static int calls = 0; calls++;
    return (float4)(0.0f);
}
