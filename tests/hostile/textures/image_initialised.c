// expect: 4:20: images come from the scene; give the texture an argument of type sam2D
float4 t(int n)
{
    sam2D forged = { n };
    return tex2D(forged, (float2)(0.5f));
}
