// expect: 4:27: passing 'void *' to parameter of type 'const void *' changes address space of pointer; correct it to C99 with OpenCL's vectors
float4 t(float x, int n)
{
    void* p = &&end; goto *p; end: x = 1.0f;
    return (float4)(0.0f);
}
