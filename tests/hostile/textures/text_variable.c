// expect: 4:9: text is only for the names in readAttr, readSetting and readOcclusion; use numbers
float4 t(float x, int n)
{
    n = "abc"[0];
    return (float4)(0.0f);
}
