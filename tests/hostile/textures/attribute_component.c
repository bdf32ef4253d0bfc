// expect: 4:25: unknown attribute "Nornal"; did you mean "Normal"? Known: WorldPos, LocalPos, Normal, GeomNormal, Tangent, Bitangent, TexCoord0, TexCoord1, TexCoord0Dx, TexCoord0Dy, VertexColor, ViewDir, ObjectId, InstanceId, PrimitiveId, Time
float4 t(float x)
{
    float up = readAttr("Nornal").y;
    return (float4)(up);
}
