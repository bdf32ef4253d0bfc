// expect: 5:12: only a variable's component can be chosen by an index; store the vector in a variable first
float4 t(float x, int n)
{
    float4 v = x;
    return v.xy[n];
}
