// expect: 4:5: 'break' statement not in loop or switch statement; correct it to C99 with OpenCL's vectors
float4 t(float x, int n)
{
    break;
    return (float4)(0.0f);
}
