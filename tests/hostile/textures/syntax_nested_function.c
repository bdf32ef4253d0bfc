// expect: 4:26: function definition is not allowed here; correct it to C99 with OpenCL's vectors
float4 t(float x, int n)
{
    float inner(float a) { return a; }
    return (float4)(0.0f);
}
