// expect: 4:5: unknown function 'StoreNormal': a texture cannot write into the renderer; return the value, and let the scene use it as a normal
float4 main(const SurfaceInfo* hit, float x)
{
    StoreNormal(hit, x);
    return (float4)(x);
}
