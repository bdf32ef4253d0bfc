// expect: 4:15: expected expression; correct it to C99 with OpenCL's vectors
float4 t(float x, int n)
{
    float y = [](float a) { return a; }(x);
    return (float4)(0.0f);
}
