// expect: 2:29: text is only for the names in readAttr, readSetting and readOcclusion; use numbers
static const char names[] = "WorldPos";
float4 t(float x, int n)
{
    float3 p = readAttr(names);
    return (float4)(0.0f);
}
