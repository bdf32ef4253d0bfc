// expect: 4:24: vector component access exceeds type 'float2' (vector of 2 'float' values); components are x y z w, or s0 to sf
float4 t(float x, int n)
{
    float2 v = x; x = v.z;
    return (float4)(0.0f);
}
