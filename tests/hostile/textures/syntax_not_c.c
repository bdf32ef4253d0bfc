// expect: 2:1: unknown type name 'def'; textures have C's and OpenCL's types, sam2D and their own
def texture(uv): return uv
