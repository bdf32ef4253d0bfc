// expect: 4:12: expression is not assignable; assign to a variable
float4 t(float x, int n)
{
    sin(x) = 1.0f;
    return (float4)(0.0f);
}
