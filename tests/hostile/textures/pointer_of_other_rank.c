// expect: 6:17: incompatible pointer types passing 'float[2][3]' to parameter of type 'const float *'; pass an array of the parameter's own type
float pick(const float* a, int k) { return a[k]; }
float4 t(int n)
{
    float a[2][3];
    return pick(a, n);
}
