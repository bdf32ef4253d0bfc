// expect: 6:9: passing 'const float *' to parameter of type 'float *' discards qualifiers; it cannot be changed: copy it to a variable of your own
void put(float* out) { *out = 1.0f; }
float4 t(float x)
{
    const float kept = x;
    put(&kept);
    return (float4)(kept);
}
