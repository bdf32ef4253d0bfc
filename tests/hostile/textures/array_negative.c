// expect: 4:13: 'a' declared as an array with a negative size; correct it to C99 with OpenCL's vectors
float4 t(float x, int n)
{
    float a[-1];
    return (float4)(0.0f);
}
