// expect: 4:25: expected expression; correct it to C99 with OpenCL's vectors
float4 t(float x, int n)
{
    float3 p = readAttr("WorldPos);
    return (float4)(0.0f);
}
