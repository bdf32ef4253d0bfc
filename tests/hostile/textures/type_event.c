// expect: 4:5: 'event_t' is reserved by OpenCL C; choose another name
float4 t(float x, int n)
{
    event_t e;
    return (float4)(0.0f);
}
