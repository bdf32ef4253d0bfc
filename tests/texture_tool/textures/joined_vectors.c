// Vectors put together from vectors. A file of its own, because Oclgrind 21.10 ends with a fault where
// two float2 make a float4 and it looks for uninitialised values (in any kernel, not only here).
float4 joined(float2 low, float scale)
{
    float4 v = readAttr("WorldPos").x * scale;
    float8 wide = (float8)(v, (float2)(1, 2), low);
    v = (float4)(v.xy, (float2)(0)) + (float4)(low, low) + (float4)((float3)(0.5f), 1);
    v.lo = (float2)(v.w, low.y);
    return v + (float4)(wide.lo.hi, wide.hi.lo) + (float4)(wide.s6, (float2)(wide.s7), 0.25f);
}
