// expect: 4:25: images come from the scene; give the texture an argument of type sam2D
float4 t(int n)
{
    return tex2D((sam2D){n * 1000000}, (float2)(0.5f));
}
