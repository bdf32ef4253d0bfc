// expect: 4:12: 'vload4' is not available to textures; use OpenCL's math, geometric, common, relational and integer functions
float4 t(const float* a)
{
    return vload4(0, a);
}
