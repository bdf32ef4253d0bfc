// expect: 4:27: recursion: f calls g calls f; GPUs have no call stack, use a loop
float g(float x);
float f(float x) { return g(x); }
float g(float x) { return f(x); }
float4 t(float x) { return (float4)(f(x)); }
