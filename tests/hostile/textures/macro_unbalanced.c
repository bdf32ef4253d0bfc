// expect: 3:44: expected '}'; add it
#define BEGIN {
float4 t(float x) BEGIN return (float4)(x);
