// expect: 3:6: expected expression; correct it to C99 with OpenCL's vectors
#define OPEN [
OPEN OPEN gnu::constructor]] void run(void) { }
float4 t(float2 uv) { return (float4)(uv, 0.0f, 1.0f); }
