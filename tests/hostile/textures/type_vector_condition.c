// expect: 4:5: statement requires expression of scalar type ('int __attribute__((ext_vector_type(3)))' (vector of 3 'int' values) invalid); correct it to C99 with OpenCL's vectors
float4 t(float x, int n)
{
    if ((float3)(1.0f) < (float3)(2.0f)) x = 1.0f;
    return (float4)(0.0f);
}
