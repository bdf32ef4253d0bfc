// expect: 4:5: expected expression; correct it to C99 with OpenCL's vectors
float4 t(float x, int n)
{
    else x = 1;
    return (float4)(0.0f);
}
