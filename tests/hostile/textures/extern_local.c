// expect: 4:18: 'y' would keep its value between paths; make it static const with a value, or drop the word static
float4 t(float x, int n)
{
    extern float y; x = y;
    return (float4)(0.0f);
}
