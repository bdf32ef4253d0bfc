// expect: 4:16: 'convert_double' is not available to textures; use OpenCL's math, geometric, common, relational and integer functions
float4 t(float x, int n)
{
    x = (float)convert_double(x);
    return (float4)(0.0f);
}
