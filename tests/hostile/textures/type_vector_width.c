// expect: 4:24: too few elements in vector initialization (expected 3 elements, have 2); correct it to C99 with OpenCL's vectors
float4 t(float x, int n)
{
    float3 v = (float3)(1.0f, 2.0f);
    return (float4)(0.0f);
}
