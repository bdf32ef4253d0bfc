// expect: 4:13: 'f' is not of a type of the language; use numbers, vectors, sam2D, structs and arrays
float4 t(float x, int n)
{
    float (^f)(float) = ^(float a) { return a; };
    return (float4)(0.0f);
}
