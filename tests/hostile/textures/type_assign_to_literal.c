// expect: 4:10: expression is not assignable; assign to a variable
float4 t(float x, int n)
{
    1.0f = x;
    return (float4)(0.0f);
}
