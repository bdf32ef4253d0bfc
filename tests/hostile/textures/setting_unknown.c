// expect: 4:21: unknown setting "Gravity"; nearest: "Time"; known: Time, Frame, Width, Height, Samples
float4 t(float x, int n)
{
    x = readSetting("Gravity");
    return (float4)(0.0f);
}
