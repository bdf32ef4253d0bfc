// expect: 5:12: a constant is shifted by more than 31 or less than 0, which compilers take differently; write its value
float4 t(int n)
{
    switch (n) {
    case 1 << 33: return 1;
    }
    return 0;
}
