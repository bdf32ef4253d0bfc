// expect: 4:21: expression is not assignable; assign to a variable
float4 t(float x, int n)
{
    float a[3]; a[1 = 2;
    return (float4)(0.0f);
}
