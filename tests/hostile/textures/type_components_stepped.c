// expect: 4:23: cannot increment value of type 'float2' (vector of 2 'float' values); correct it to C99 with OpenCL's vectors
float4 t(float x, int n)
{
    float3 v = x; v.xy++;
    return (float4)(0.0f);
}
