float4 userProc(sam2D tex1, sam2D tex2)
{
    float2 texCoord = readAttr("TexCoord0");
    float4 texColor1 = tex2D(tex1, texCoord);
    float4 texColor2 = tex2D(tex2, texCoord);
    return texColor1*texColor2;
}
