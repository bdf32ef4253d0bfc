// expect: 4:25: the name must be written here as text, because what is not asked for is not computed; write readAttr("...")
float4 t(float x, int n)
{
    float3 p = readAttr(n ? "WorldPos" : "Normal");
    return (float4)(0.0f);
}
