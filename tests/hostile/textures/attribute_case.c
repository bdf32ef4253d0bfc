// expect: 4:25: unknown attribute "worldpos"; did you mean "WorldPos"? Known: WorldPos, LocalPos, Normal, GeomNormal, Tangent, Bitangent, TexCoord0, TexCoord1, TexCoord0Dx, TexCoord0Dy, VertexColor, ViewDir, ObjectId, InstanceId, PrimitiveId, Time
float4 t(float x, int n)
{
    float3 p = readAttr("worldpos");
    return (float4)(0.0f);
}
