// Somebody's own OpenCL program that runs foreign_program.cl (preprocessed, first argument) on the
// first device there is and prints the bits of its results. Exit code 77: no device.
#define CL_TARGET_OPENCL_VERSION 120

#include <CL/cl.h>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

int main(int, char** values)
{
    std::ifstream file(values[1]);
    const std::string source{std::istreambuf_iterator<char>(file), {}};
    cl_platform_id platform = nullptr;
    cl_device_id device = nullptr;
    if (clGetPlatformIDs(1, &platform, nullptr) ||
        clGetDeviceIDs(platform, CL_DEVICE_TYPE_ALL, 1, &device, nullptr))
        return 77;
    cl_context context = clCreateContext(nullptr, 1, &device, nullptr, nullptr, nullptr);
    cl_command_queue queue = clCreateCommandQueue(context, device, 0, nullptr);
    const char* text = source.c_str();
    cl_program program = clCreateProgramWithSource(context, 1, &text, nullptr, nullptr);
    if (clBuildProgram(program, 1, &device, "-cl-std=CL1.2 -w", nullptr, nullptr)) {
        std::vector<char> log(100000);
        clGetProgramBuildInfo(program, device, CL_PROGRAM_BUILD_LOG, log.size() - 1, log.data(),
                              nullptr);
        std::fprintf(stderr, "%s\n", log.data());
        return 1;
    }
    cl_kernel kernel = clCreateKernel(program, "evaluate", nullptr);
    cl_mem results = clCreateBuffer(context, CL_MEM_READ_WRITE, 64 * 16, nullptr, nullptr);
    cl_mem faults = clCreateBuffer(context, CL_MEM_READ_WRITE, 64 * 8, nullptr, nullptr);
    clSetKernelArg(kernel, 0, sizeof results, &results);
    clSetKernelArg(kernel, 1, sizeof faults, &faults);
    const size_t size = 64;
    clEnqueueNDRangeKernel(queue, kernel, 1, nullptr, &size, nullptr, 0, nullptr, nullptr);
    float v[64][4];
    int f[64][2];
    if (clEnqueueReadBuffer(queue, results, CL_TRUE, 0, sizeof v, v, 0, nullptr, nullptr) ||
        clEnqueueReadBuffer(queue, faults, CL_TRUE, 0, sizeof f, f, 0, nullptr, nullptr))
        return 1;
    for (int k = 0; k < 64; ++k)
        std::printf("%.9g %.9g %.9g %.9g %d %d\n", v[k][0], v[k][1], v[k][2], v[k][3], f[k][0],
                    f[k][1]);
}
