// expect: 2:16: a scene cannot give the texture's parameter 's'; arguments are int, uint and float, their vectors of 2, 3 and 4, sam2D, and const arrays of these
float4 t(short s) { return (float4)(s); }
