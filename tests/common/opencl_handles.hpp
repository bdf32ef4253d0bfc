// OpenCL for tests that compare bits: every device, and handles that let go of what they hold.
#pragma once

#ifndef CL_TARGET_OPENCL_VERSION
#define CL_TARGET_OPENCL_VERSION 120
#endif

#include <CL/cl.h>

#include <memory>
#include <vector>

inline std::vector<cl_device_id> all_devices()
{
    cl_uint platform_count = 0;
    clGetPlatformIDs(0, nullptr, &platform_count);
    std::vector<cl_platform_id> platforms(platform_count);
    clGetPlatformIDs(platform_count, platforms.data(), nullptr);
    std::vector<cl_device_id> devices;
    for (cl_platform_id platform : platforms) {
        cl_uint count = 0;
        clGetDeviceIDs(platform, CL_DEVICE_TYPE_ALL, 0, nullptr, &count);
        std::vector<cl_device_id> found(count);
        clGetDeviceIDs(platform, CL_DEVICE_TYPE_ALL, count, found.data(), nullptr);
        devices.insert(devices.end(), found.begin(), found.end());
    }
    return devices;
}

// The sources promise equal bits where arithmetic is IEEE's throughout.
inline bool has_exact_arithmetic(cl_device_id device)
{
    cl_device_fp_config config = 0;
    clGetDeviceInfo(device, CL_DEVICE_SINGLE_FP_CONFIG, sizeof(config), &config, nullptr);
    const cl_device_fp_config needed = CL_FP_DENORM | CL_FP_CORRECTLY_ROUNDED_DIVIDE_SQRT;
    return (config & needed) == needed;
}

template<auto release>
struct Release {
    template<class Handle>
    void operator()(Handle* handle) const
    {
        release(handle);
    }
};
using Context = std::unique_ptr<_cl_context, Release<clReleaseContext>>;
using Queue = std::unique_ptr<_cl_command_queue, Release<clReleaseCommandQueue>>;
using Program = std::unique_ptr<_cl_program, Release<clReleaseProgram>>;
using Kernel = std::unique_ptr<_cl_kernel, Release<clReleaseKernel>>;
using Buffer = std::unique_ptr<_cl_mem, Release<clReleaseMemObject>>;
