// expect: 5:27: images come from the scene; give the texture an argument of type sam2D
struct Layer { float weight; sam2D image; };
float4 t(int n)
{
    struct Layer l = { 1, 7 };
    return tex2D(l.image, (float2)(0.5f));
}
