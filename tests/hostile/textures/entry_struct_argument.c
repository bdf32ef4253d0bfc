// expect: 3:19: a scene cannot give the texture's parameter 's'; arguments are int, uint and float, their vectors of 2, 3 and 4, sam2D, and const arrays of these
struct S { float a; };
float4 t(struct S s) { return (float4)(s.a); }
