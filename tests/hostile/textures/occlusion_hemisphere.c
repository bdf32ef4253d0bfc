// expect: 4:23: no such hemisphere; write "upper", "lower" or "both", with " same_object" after it where only the object itself occludes
float4 t(float x, int n)
{
    x = readOcclusion("left", 1.0f);
    return (float4)(0.0f);
}
