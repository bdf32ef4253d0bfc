float3 paperAttributes(void)
{
    float3 pos = readAttr("WorldPos"); float3 norm = readAttr("Normal"); float3 tang = readAttr("Tangent");
    return pos + 2.0f * norm + 4.0f * tang;
}
