// expect: 4:5: 'case' statement not in switch statement; correct it to C99 with OpenCL's vectors
float4 t(float x, int n)
{
    case 1: x = 1;
    return (float4)(0.0f);
}
