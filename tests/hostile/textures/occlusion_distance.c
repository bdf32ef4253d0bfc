// expect: 4:32: the distance must be known before the texture runs; use a number or one of the texture's own float arguments, which another node may give
float4 t(float x, int n)
{
    x = readOcclusion("upper", x * 2.0f);
    return (float4)(0.0f);
}
