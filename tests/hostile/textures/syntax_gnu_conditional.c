// expect: 4:11: used type 'float' where floating point type is not allowed; correct it to C99 with OpenCL's vectors
float4 t(float x, int n)
{
    x = x ?: 1.0f;
    return (float4)(0.0f);
}
