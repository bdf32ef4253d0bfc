// expect: 4:9: 'get_global_id' is not available to textures; use OpenCL's math, geometric, common, relational and integer functions
float4 t(float x, int n)
{
    n = get_global_id(0);
    return (float4)(0.0f);
}
