// expect: 4:11: 'a' takes 400000000 bytes of each path's own memory, more than 16384; make it smaller, a static const table or an argument
float4 t(float x, int n)
{
    float a[100000000];
    return (float4)(0.0f);
}
