// expect: 2:10: 'double' is not available on every device; use float
float4 t(double x) { return (float4)(0.0f); }
