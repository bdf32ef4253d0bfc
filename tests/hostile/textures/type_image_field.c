// expect: 4:30: an image has no fields; read it with tex2D
float4 t(sam2D a)
{
    return (float4)((float)a.slot_);
}
