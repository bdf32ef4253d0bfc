// expect: 4:5: 'mem_fence' is not available to textures; use OpenCL's math, geometric, common, relational and integer functions
float4 t(float x, int n)
{
    mem_fence(1);
    return (float4)(0.0f);
}
