// expect: 3:37: 'f' is declared but nowhere defined; define it in this file
float f(float x);
float4 t(float x) { return (float4)(f(x)); }
