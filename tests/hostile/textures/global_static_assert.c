// expect: 2:1: this declaration is not part of the language; only functions, constants, structs, unions, enums and typedefs are
_Static_assert(1, "yes");
float4 t(float2 uv) { return (float4)(uv, 0.0f, 1.0f); }
