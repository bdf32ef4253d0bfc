// expect: 3:29: an image shares its bytes with numbers; keep images in variables, arrays and structs
struct Layer { sam2D images[2]; };
union Forged { struct Layer layer; int numbers[2]; };
float4 t(int n)
{
    union Forged u;
    u.numbers[1] = n;
    return tex2D(u.layer.images[1], (float2)(0.5f));
}
