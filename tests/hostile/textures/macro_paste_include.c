// expect: 3:1: #inc is not part of the language; remove it
#define inc include
#inc <math.h>
float4 t(float2 uv) { return (float4)(uv, 0.0f, 1.0f); }
