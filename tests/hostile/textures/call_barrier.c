// expect: 4:5: 'barrier' is not available to textures; use OpenCL's math, geometric, common, relational and integer functions
float4 t(float x, int n)
{
    barrier(1);
    return (float4)(0.0f);
}
