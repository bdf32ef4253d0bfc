// expect: 4:25: this is not the hit; readAttr takes the name alone, or after the parameter of type const SurfaceInfo*
float4 main(const SurfaceInfo* hit)
{
    float3 p = readAttr(0, "WorldPos");
    return (float4)(p, 1.0f);
}
