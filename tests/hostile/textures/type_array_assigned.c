// expect: 4:25: array type 'float[2]' is not assignable; assign to a variable
float4 t(float x, int n)
{
    float a[2], b[2]; a = b;
    return (float4)(0.0f);
}
