// A texture in a foreign program.
float fade(float t) { return t * t * (3.0f - 2.0f * t); }
float4 userProc(sam2D tex1, float3 tint)
{
    float3 pos = readAttr("WorldPos");
    float2 texCoord = readAttr("TexCoord0");
    float3 n = normalize(cross(pos, make_float3(0.0f, 1.0f, 0.0f)));
    float4 c = tex2D(tex1, texCoord);
    c.xyz = mix(c.xyz, tint * 2.0f, fade(0.25f)) + n;
    c.x += sin(pos.y) + max(pos.x, 0.5f);
    c.zw = c.wz * 0.5f;
    c *= clamp(length(pos.xz), 0.0f, 1.0f);
    return floor(c * 16.0f) / 16.0f;
}
