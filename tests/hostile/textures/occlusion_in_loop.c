// expect: 4:38: occlusion is traced once for each request, before the texture; ask for it outside of the loop
float4 t(float x, int n)
{
    for (int i = 0; i < 4; ++i) x += readOcclusion("upper", 1.0f);
    return (float4)(0.0f);
}
