float3 fract(float3 x) { return x - floor(x); }
float mix(float a, float b, float t) { return a * (1 - t) + b * t; }
float4 main(const SurfaceInfo* sHit, sampler2D tex, const float3 colors[3], const unsigned* ids, const float* k)
{
  const float3 pos = readAttr(sHit, "ModelPos");
  const float2 uv = readAttr(sHit, "TexCoord0");
  float3 n = readAttr(sHit, "Norm");
  float ao = readAttr(sHit, "AO");
  float4 c = texture2D(tex, uv, TEX_CLAMP_U);
  float3x3 m; m.row[0] = n; m.row[1] = pos; m.row[2] = make_float3(1, 2, 3);
  c.xyz = mul3x3x3(m, to_float3(c)) * mix(0.0, 1.0, ao) + fract(pos);
  return to_float4(c.xyz, 1.0f) + (ids[0] & 7) + k[2];
}
