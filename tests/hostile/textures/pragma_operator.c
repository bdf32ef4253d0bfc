// expect: 2:1: _Pragma is not part of the language; remove it
_Pragma("GCC poison float")
float4 t(float2 uv) { return (float4)(uv, 0.0f, 1.0f); }
