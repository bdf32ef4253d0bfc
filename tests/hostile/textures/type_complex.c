// expect: 4:20: 'z' is not of a type of the language; use numbers, vectors, sam2D, structs and arrays
float4 t(float x, int n)
{
    _Complex float z = x;
    return (float4)(0.0f);
}
