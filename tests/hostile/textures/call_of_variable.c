// expect: 4:10: called object type 'float' is not a function or function pointer; GPUs have none: call the function by its name
float4 t(float x, int n)
{
    x = x(1.0f);
    return (float4)(0.0f);
}
