// expect: 2:10: 'sampler_t' is reserved by OpenCL C; choose another name
float4 t(sampler_t s) { return (float4)(0.0f); }
