// expect: 5:21: address of vector element requested; correct it to C99 with OpenCL's vectors
void f(float* a) { *a = 1.0f; }
float4 t(float x, int n)
{
    float3 v = x; f(&v.x);
    return (float4)(0.0f);
}
