// expect: 2:1: #import reads another file, which textures may not; paste what you need of it, OpenCL's functions are there without it
#import <math.h>
float4 t(float2 uv) { return (float4)(uv, 0.0f, 1.0f); }
