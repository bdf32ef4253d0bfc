// expect: 2:11: 'math.h' file not found; correct it to C99 with OpenCL's vectors
%:include <math.h>
float4 t(float2 uv) { return (float4)(uv, 0.0f, 1.0f); }
