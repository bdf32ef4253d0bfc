// expect: 2:10: 'image2d_t' is reserved by OpenCL C; choose another name
float4 t(image2d_t image) { return (float4)(0.0f); }
