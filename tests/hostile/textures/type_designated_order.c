// expect: 5:19: initialisers by name are not C++'s where their order differs; list the values in the order of the fields
struct S { float a, b; };
float4 t(float x, int n)
{
    struct S s = {.b = 1.0f, .a = 2.0f};
    return (float4)(0.0f);
}
