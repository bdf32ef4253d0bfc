// The same bits from every OpenCL device as from C++, for each row of shared_functions.h.
#include "tests/common/function_loops.hpp"
#include "tests/common/opencl_handles.hpp"
#include "tests/common/sample_floats.hpp"

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <gtest/gtest.h>
#include <iterator>
#include <memory>
#include <stdexcept>
#include <string>

namespace {

std::string name_of(cl_device_id device)
{
    char name[256] = {};
    clGetDeviceInfo(device, CL_DEVICE_NAME, sizeof(name) - 1, name, nullptr);
    return name;
}

std::string kernel_source()
{
    std::ifstream file(FUNCTION_KERNELS);
    return {std::istreambuf_iterator<char>(file), {}};
}

// One device with the compiled rows and their arguments.
class Runner {
public:
    Runner(cl_device_id device, const FloatPairs& pairs) : count_(pairs.a.size())
    {
        context_.reset(clCreateContext(nullptr, 1, &device, nullptr, nullptr, nullptr));
        queue_.reset(clCreateCommandQueue(context_.get(), device, 0, nullptr));
        const std::string source = kernel_source();
        const char* text = source.c_str();
        program_.reset(clCreateProgramWithSource(context_.get(), 1, &text, nullptr, nullptr));
        const char* options = "-cl-std=CL1.2 -cl-fp32-correctly-rounded-divide-sqrt";
        if (clBuildProgram(program_.get(), 1, &device, options, nullptr, nullptr) != CL_SUCCESS) {
            std::string log(1 << 16, '\0');
            clGetProgramBuildInfo(program_.get(), device, CL_PROGRAM_BUILD_LOG, log.size(),
                                  log.data(), nullptr);
            throw std::runtime_error(name_of(device) + ": " + log.c_str());
        }
        a_ = buffer_of(pairs.a);
        b_ = buffer_of(pairs.b);
        out_.reset(clCreateBuffer(context_.get(), CL_MEM_WRITE_ONLY, count_ * sizeof(std::uint32_t),
                                  nullptr, nullptr));
    }

    std::vector<std::uint32_t> run(const std::string& row)
    {
        const Kernel kernel(clCreateKernel(program_.get(), (row + "_kernel").c_str(), nullptr));
        const cl_mem arguments[] = {a_.get(), b_.get(), out_.get()};
        for (cl_uint i = 0; i < 3; ++i) {
            clSetKernelArg(kernel.get(), i, sizeof(cl_mem), &arguments[i]);
        }
        std::vector<std::uint32_t> results(count_, 0xdeadbeefu);
        const cl_int launched = clEnqueueNDRangeKernel(queue_.get(), kernel.get(), 1, nullptr,
                                                       &count_, nullptr, 0, nullptr, nullptr);
        const cl_int read = clEnqueueReadBuffer(queue_.get(), out_.get(), CL_TRUE, 0,
                                                count_ * sizeof(std::uint32_t), results.data(), 0,
                                                nullptr, nullptr);
        EXPECT_EQ(launched, CL_SUCCESS) << row;
        EXPECT_EQ(read, CL_SUCCESS) << row;
        return results;
    }

private:
    Buffer buffer_of(const std::vector<float>& values)
    {
        return Buffer(clCreateBuffer(context_.get(), CL_MEM_READ_ONLY | CL_MEM_COPY_HOST_PTR,
                                     values.size() * sizeof(float),
                                     const_cast<float*>(values.data()), nullptr));
    }

    std::size_t count_;
    Context context_;
    Queue queue_;
    Program program_;
    Buffer a_;
    Buffer b_;
    Buffer out_;
};

TEST(SharedMath, GivesTheSameBitsInOpenCl)
{
    const std::vector<cl_device_id> devices = all_devices();
    if (devices.empty()) {
        GTEST_SKIP() << "no OpenCL device found";
    }
    const FloatPairs pairs = float_pairs(4099);
    std::vector<std::uint32_t> expected(pairs.a.size());
    for (cl_device_id device : devices) {
        if (!has_exact_arithmetic(device)) {
            std::printf("%s: skipped, it has no denormals or no exact division\n",
                        name_of(device).c_str());
            continue;
        }
        Runner runner(device, pairs);
        for (int f = 0; f < loops_debug::loop_count; ++f) {
            const NamedLoop& loop = loops_debug::loops[f];
            loop.run(pairs.a.data(), pairs.b.data(), expected.data(),
                     static_cast<int>(pairs.a.size()));
            const std::vector<std::uint32_t> results = runner.run(loop.name);
            const auto [e, r] = std::ranges::mismatch(expected, results);
            const auto i = e - expected.begin();
            EXPECT_TRUE(e == expected.end())
                << name_of(device) << ": " << loop.name << "(" << pairs.a[i] << ", " << pairs.b[i]
                << "): bits " << std::hex << *e << " in C++, " << *r << " in OpenCL";
        }
    }
}

}  // namespace
