// expect: 2:1: #ident is not part of the language; remove it
#ident "x"
float4 t(float2 uv) { return (float4)(uv, 0.0f, 1.0f); }
