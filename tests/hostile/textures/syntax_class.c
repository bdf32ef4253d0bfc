// expect: 2:1: unknown type name 'class'; textures have C's and OpenCL's types, sam2D and their own
class Noise { float seed; };
float4 t(float2 uv) { return (float4)(uv, 0.0f, 1.0f); }
