// expect: 2:17: a scene cannot give the texture's parameter 'v'; arguments are int, uint and float, their vectors of 2, 3 and 4, sam2D, and const arrays of these
float4 t(float8 v) { return v.lo; }
