// An image laid on a surface from three sides, for meshes without texture coordinates.
// Result: a colour and alpha.
//
// image (sam2D; default white): repeats in both directions
// scale (float, 1/m, above 0; default 1): images for each metre of the world
// sharpness (float, 0 to 0.99; default 0.6): 0 blends the sides softly, near 1 hardly

// How much a side shows whose axis has this component of the normal. The largest component of a
// unit vector is at least 0.577, so that one of three sides always shows.
float triplanar_weight(float n, float sharpness)
{
    const float rest = fabs(n) - 0.577f * sharpness;
    const float shown = rest > 0.0f ? rest : 0.0f;
    return shown * shown;
}

float4 triplanar(sam2D image, float scale, float sharpness)
{
    const float3 place = readAttr("WorldPos");
    const float3 normal = readAttr("Normal");
    const float3 p = place * scale;
    const float x = triplanar_weight(normal.x, sharpness);
    const float y = triplanar_weight(normal.y, sharpness);
    const float z = triplanar_weight(normal.z, sharpness);
    // Mirrored on the far sides, so that writing can be read from everywhere.
    const float4 from_x = tex2D(image, make_float2(normal.x < 0.0f ? p.z : -p.z, -p.y));
    const float4 from_y = tex2D(image, make_float2(p.x, normal.y < 0.0f ? -p.z : p.z));
    const float4 from_z = tex2D(image, make_float2(normal.z < 0.0f ? -p.x : p.x, -p.y));
    return (from_x * x + from_y * y + from_z * z) / (x + y + z + 1.0e-20f);
}
