// expect: 4:11: definition of variable with array type needs an explicit size or an initializer; correct it to C99 with OpenCL's vectors
float4 t(float x, int n)
{
    float a[];
    return (float4)(0.0f);
}
