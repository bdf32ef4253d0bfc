// expect: 14:8: 'bomb' with all that it calls is longer than 100000 words; every call is copied into the kernel, use loops
float f0(float x) { return sin(x) * cos(x * 1.5f) + pow(x, 1.25f); }
float f1(float x) { return f0(x) + f0(x * 1.25f); }
float f2(float x) { return f1(x) + f1(x * 1.25f); }
float f3(float x) { return f2(x) + f2(x * 1.25f); }
float f4(float x) { return f3(x) + f3(x * 1.25f); }
float f5(float x) { return f4(x) + f4(x * 1.25f); }
float f6(float x) { return f5(x) + f5(x * 1.25f); }
float f7(float x) { return f6(x) + f6(x * 1.25f); }
float f8(float x) { return f7(x) + f7(x * 1.25f); }
float f9(float x) { return f8(x) + f8(x * 1.25f); }
float f10(float x) { return f9(x) + f9(x * 1.25f); }
float f11(float x) { return f10(x) + f10(x * 1.25f); }
float4 bomb(float x) { return (float4)(f11(x)); }
