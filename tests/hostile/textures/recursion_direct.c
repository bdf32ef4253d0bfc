// expect: 2:38: recursion: f calls f; GPUs have no call stack, use a loop
float f(float x) { return x > 1.0f ? f(x - 1.0f) : x; }
float4 t(float x) { return (float4)(f(x)); }
