// expect: 4:23: invalid argument type 'float3' (vector of 3 'float' values) to unary expression; correct it to C99 with OpenCL's vectors
float4 t(float x, int n)
{
    float3 v = x; v = ~v;
    return (float4)(0.0f);
}
