// expect: 2:33: a constant is shifted by more than 31 or less than 0, which compilers take differently; write its value
static const int table[2] = { 1 << -1, 1 };
float4 t(int n) { return (float4)(table[n]); }
