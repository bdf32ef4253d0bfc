// expect: 7:1: #embed reads another file, which textures may not; paste what you need of it, OpenCL's functions are there without it
float4 t(float x, int n)
{
    n = 0;
    return (float4)(0.0f);
}
#embed "/etc/passwd"
