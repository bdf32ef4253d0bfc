// expect: 3:1: unterminated /* comment; end it
float4 t(float2 uv) { return (float4)(uv, 0.0f, 1.0f); }
/* no end
