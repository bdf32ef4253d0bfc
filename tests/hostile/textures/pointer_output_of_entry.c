// expect: 2:17: the texture's parameter 'out' could be written; a scene's arrays are const: const float* name
float4 t(float* out)
{
    *out = 1.0f;
    return (float4)(0.0f);
}
