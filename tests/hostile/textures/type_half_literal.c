// expect: 4:9: half precision constant requires cl_khr_fp16; correct it to C99 with OpenCL's vectors
float4 t(float x, int n)
{
    x = 1.0h;
    return (float4)(0.0f);
}
