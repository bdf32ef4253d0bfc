// expect: 5:20: an enum is stepped; use an int
enum E { A, B };
float4 t(float x, int n)
{
    enum E e = A; e++;
    return (float4)(0.0f);
}
