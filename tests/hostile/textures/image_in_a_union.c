// expect: 2:22: an image shares its bytes with numbers; keep images in variables, arrays and structs
union Forged { sam2D image; int number; };
float4 t(int n)
{
    union Forged u;
    u.number = n;
    return tex2D(u.image, (float2)(0.5f));
}
