// expect: 1:1: several functions could be the texture: a, b; name one of them
float4 a(float x) { return (float4)(x); }
float4 b(float x) { return (float4)(x); }
