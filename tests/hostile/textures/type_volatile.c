// expect: 4:20: 'y' is volatile, which textures need not be; remove the word
float4 t(float x, int n)
{
    volatile float y = x;
    return (float4)(0.0f);
}
