// expect: 4:12: the distance must be known before the texture runs; ask in 't' itself and hand the result on
float f(float d)
{
    return readOcclusion("upper", d);
}
float4 t(float d) { return (float4)(f(d)); }
