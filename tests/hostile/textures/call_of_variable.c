// expect: 4:10: called object type 'float' is not a function or function pointer; a variable hides what has its name: rename it, or call a function
float4 t(float x, int n)
{
    x = x(1.0f);
    return (float4)(0.0f);
}
