// expect: 4:12: pointers to functions are not allowed; GPUs have none: call the function by its name
float4 t(float x, int n)
{
    float (*f)(float) = 0;
    return (float4)(0.0f);
}
