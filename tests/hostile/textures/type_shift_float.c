// expect: 4:11: invalid operands to binary expression ('float' and 'int'); make both sides the same type: convert_float3(v), v.xyz, (float3)(x)
float4 t(float x, int n)
{
    x = x << 1;
    return (float4)(0.0f);
}
