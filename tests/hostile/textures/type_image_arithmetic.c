// expect: 4:23: invalid operands to binary expression ('sam2D' (aka 'struct sam2D_') and 'int'); make both sides the same type: convert_float3(v), v.xyz, (float3)(x)
float4 t(sam2D a)
{
    return (float4)(a + 1);
}
