// expect: 4:16: 'a' is not of a type of the language; use numbers, vectors, sam2D, structs and arrays
float4 t(float x, int n)
{
    atomic_int a;
    return (float4)(0.0f);
}
