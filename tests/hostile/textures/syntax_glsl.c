// expect: 2:1: unknown type name 'vec4'; textures have C's and OpenCL's types, sam2D and their own
vec4 t(vec2 uv) { return vec4(uv, 0.0, 1.0); }
