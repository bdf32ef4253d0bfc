// expect: 4:5: use of undeclared identifier 'vec3'; declare it first
float4 t(float x, int n)
{
    vec3 v;
    return (float4)(0.0f);
}
