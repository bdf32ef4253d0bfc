// expect: 10:8: the variables of 't' and what it calls take 128000 bytes for each path, more than 65536; use fewer
float f0(float x, int n) { float a[4000]; a[n] = x; return a[0]; }
float f1(float x, int n) { float a[4000]; a[n] = x; return a[0] + f0(x, n); }
float f2(float x, int n) { float a[4000]; a[n] = x; return a[0] + f1(x, n); }
float f3(float x, int n) { float a[4000]; a[n] = x; return a[0] + f2(x, n); }
float f4(float x, int n) { float a[4000]; a[n] = x; return a[0] + f3(x, n); }
float f5(float x, int n) { float a[4000]; a[n] = x; return a[0] + f4(x, n); }
float f6(float x, int n) { float a[4000]; a[n] = x; return a[0] + f5(x, n); }
float f7(float x, int n) { float a[4000]; a[n] = x; return a[0] + f6(x, n); }
float4 t(float x, int n) { return (float4)(f7(x, n)); }
