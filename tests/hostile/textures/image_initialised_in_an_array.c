// expect: 4:25: images come from the scene; give the texture an argument of type sam2D
float4 t(int n)
{
    sam2D forged[2] = { { 7 }, { 1000000 } };
    return tex2D(forged[n], (float2)(0.5f));
}
