// expect: 4:24: incomplete definition of type 'struct SurfaceInfo'; correct it to C99 with OpenCL's vectors
float4 main(const SurfaceInfo* hit)
{
    return (float4)(hit->x);
}
