#include "backends/opencl.hpp"

#include <algorithm>
#include <stdexcept>

namespace diptych::opencl {
namespace {

// X(status without its prefix CL_, advice)
#define STATUSES(X)                                                                       \
    X(DEVICE_NOT_AVAILABLE, "is another program using it exclusively?")                   \
    X(COMPILER_NOT_AVAILABLE, "the driver has no OpenCL compiler; choose another device") \
    X(MEM_OBJECT_ALLOCATION_FAILURE, "the device is out of memory; lower --memory")       \
    X(OUT_OF_RESOURCES, "the device is out of resources or was reset; lower --memory or " \
                        "--launch-ms")                                                    \
    X(OUT_OF_HOST_MEMORY, "the driver is out of memory; lower --memory")                  \
    X(INVALID_BUFFER_SIZE, "more than the device allocates at once; lower --memory")      \
    X(BUILD_PROGRAM_FAILURE, "the device's compiler refused it")                          \
    X(INVALID_WORK_GROUP_SIZE, "please report this device")                               \
    X(INVALID_BINARY, "")                                                                 \
    X(INVALID_VALUE, "")                                                                  \
    X(INVALID_DEVICE, "")                                                                 \
    X(INVALID_CONTEXT, "")                                                                \
    X(INVALID_COMMAND_QUEUE, "the device was lost; see the system's log")                 \
    X(INVALID_MEM_OBJECT, "")                                                             \
    X(INVALID_BUILD_OPTIONS, "")                                                          \
    X(INVALID_PROGRAM_EXECUTABLE, "")                                                     \
    X(INVALID_KERNEL_NAME, "")                                                            \
    X(INVALID_KERNEL_ARGS, "")                                                            \
    X(INVALID_ARG_SIZE, "")                                                               \
    X(INVALID_ARG_VALUE, "")                                                              \
    X(INVALID_EVENT, "")                                                                  \
    X(PROFILING_INFO_NOT_AVAILABLE, "")

std::string explain(cl_int status)
{
    switch (status) {
#define EXPLAIN(name, advice) \
    case CL_##name:           \
        return std::string("CL_" #name) + (*advice ? "; " : "") + advice;
        STATUSES(EXPLAIN)
    default:
        return "error " + std::to_string(status);
    }
}

std::string trimmed(std::string text)
{
    while (!text.empty() && (text.back() == '\0' || text.back() == ' ' || text.back() == '\n'))
        text.pop_back();
    text.erase(0, std::min(text.find_first_not_of(" \n"), text.size()));
    return text;
}

// The two-step protocol of all clGet*Info calls.
template<class Get>
std::string info_text(const char* call, const std::string& at, Get get)
{
    size_t bytes = 0;
    check(get(size_t{0}, static_cast<void*>(nullptr), &bytes), call, at);
    std::string text(bytes, '\0');
    check(get(bytes, static_cast<void*>(text.data()), nullptr), call, at);
    return trimmed(text);
}

std::string build_log(cl_program program, cl_device_id device)
{
    return info_text("clGetProgramBuildInfo", "", [&](size_t bytes, void* to, size_t* needed) {
        return clGetProgramBuildInfo(program, device, CL_PROGRAM_BUILD_LOG, bytes, to, needed);
    });
}

}  // namespace

void check(cl_int status, const char* call, const std::string& at)
{
    if (status == CL_SUCCESS) return;
    throw std::runtime_error("opencl: " + at + ": " + call + " failed: " + explain(status));
}

std::string Device::text(cl_device_info what) const
{
    return info_text("clGetDeviceInfo", "", [&](size_t bytes, void* to, size_t* needed) {
        return clGetDeviceInfo(id_, what, bytes, to, needed);
    });
}

std::string Device::platform_text(cl_platform_info what) const
{
    return info_text("clGetPlatformInfo", "", [&](size_t bytes, void* to, size_t* needed) {
        return clGetPlatformInfo(platform_, what, bytes, to, needed);
    });
}

void Device::read(cl_device_info what, size_t bytes, void* value) const
{
    check(clGetDeviceInfo(id_, what, bytes, value, nullptr), "clGetDeviceInfo", name());
}

int Device::most_parts() const
{
    size_t bytes = 0;
    check(clGetDeviceInfo(id_, CL_DEVICE_PARTITION_PROPERTIES, 0, nullptr, &bytes),
          "clGetDeviceInfo", name());
    std::vector<cl_device_partition_property> kinds(bytes / sizeof(cl_device_partition_property));
    read(CL_DEVICE_PARTITION_PROPERTIES, bytes, kinds.data());
    const bool is_divisible =
        std::find(kinds.begin(), kinds.end(), CL_DEVICE_PARTITION_EQUALLY) != kinds.end();
    const cl_uint most = std::min(number<cl_uint>(CL_DEVICE_PARTITION_MAX_SUB_DEVICES),
                                  number<cl_uint>(CL_DEVICE_MAX_COMPUTE_UNITS));
    return is_divisible && most > 1 ? int(most) : 0;
}

std::vector<Device> Device::divided(int parts) const
{
    const cl_uint units = number<cl_uint>(CL_DEVICE_MAX_COMPUTE_UNITS) / cl_uint(parts);
    const cl_device_partition_property how[] = {CL_DEVICE_PARTITION_EQUALLY,
                                                cl_device_partition_property(units), 0};
    cl_uint count = 0;
    check(clCreateSubDevices(id_, how, 0, nullptr, &count), "clCreateSubDevices", name());
    std::vector<cl_device_id> ids(count);
    check(clCreateSubDevices(id_, how, count, ids.data(), nullptr), "clCreateSubDevices", name());
    std::vector<Device> devices;
    for (cl_device_id id : ids) {
        devices.emplace_back(platform_, id);
        devices.back().part_ = std::make_shared<Handle<cl_device_id, clReleaseDevice>>(id);
    }
    if (devices.size() > size_t(parts)) devices.resize(size_t(parts));  // what is over stays idle
    return devices;
}

std::vector<Device> all_devices()
{
    cl_uint count = 0;
    if (clGetPlatformIDs(0, nullptr, &count) != CL_SUCCESS || count == 0) return {};
    std::vector<cl_platform_id> platforms(count);
    check(clGetPlatformIDs(count, platforms.data(), nullptr), "clGetPlatformIDs", "platforms");
    std::vector<Device> devices;
    for (cl_platform_id platform : platforms) {
        cl_uint found = 0;
        const cl_int status = clGetDeviceIDs(platform, CL_DEVICE_TYPE_ALL, 0, nullptr, &found);
        if (status != CL_SUCCESS || found == 0) continue;
        std::vector<cl_device_id> ids(found);
        check(clGetDeviceIDs(platform, CL_DEVICE_TYPE_ALL, found, ids.data(), nullptr),
              "clGetDeviceIDs", "platform");
        for (cl_device_id id : ids) devices.emplace_back(platform, id);
    }
    return devices;
}

std::string Program::log() const { return build_log(program_.get(), device_); }

std::string Program::binary() const
{
    size_t bytes = 0;
    check(clGetProgramInfo(program_.get(), CL_PROGRAM_BINARY_SIZES, sizeof bytes, &bytes, nullptr),
          "clGetProgramInfo", at_);
    std::string binary(bytes, '\0');
    auto* to = reinterpret_cast<unsigned char*>(binary.data());
    check(clGetProgramInfo(program_.get(), CL_PROGRAM_BINARIES, sizeof to, &to, nullptr),
          "clGetProgramInfo", at_);
    return binary;
}

double Event::seconds() const
{
    cl_ulong start = 0;
    cl_ulong end = 0;
    const auto read = [&](cl_profiling_info what, cl_ulong* to) {
        check(clGetEventProfilingInfo(event_.get(), what, sizeof *to, to, nullptr),
              "clGetEventProfilingInfo", at_);
    };
    read(CL_PROFILING_COMMAND_START, &start);
    read(CL_PROFILING_COMMAND_END, &end);
    return end > start ? 1e-9 * double(end - start) : 0.0;
}

Kernel::Kernel(const Program& program, const std::string& name)
    : at_(program.at_ + ", kernel " + name)
{
    cl_int status = CL_SUCCESS;
    kernel_ = Handle<cl_kernel, clReleaseKernel>(
        clCreateKernel(program.program_.get(), name.c_str(), &status));
    check(status, "clCreateKernel", at_);
}

void Kernel::set_bytes(int index, size_t bytes, const void* value)
{
    const cl_int status = clSetKernelArg(kernel_.get(), cl_uint(index), bytes, value);
    if (status != CL_SUCCESS)
        check(status, "clSetKernelArg", at_ + ", argument " + std::to_string(index));
}

void Kernel::set(int index, const Buffer& buffer)
{
    cl_mem memory = buffer.get();
    set_bytes(index, sizeof memory, &memory);
}

void Kernel::set(int index, int value)
{
    const cl_int number = value;
    set_bytes(index, sizeof number, &number);
}

void Queue::write(const Buffer& buffer, size_t bytes, const void* data, size_t first)
{
    if (bytes == 0) return;
    check(clEnqueueWriteBuffer(queue_.get(), buffer.get(), CL_TRUE, first, bytes, data, 0, nullptr,
                               nullptr),
          "clEnqueueWriteBuffer", at_);
}

void Queue::read(const Buffer& buffer, size_t bytes, void* data, size_t first)
{
    if (bytes == 0) return;
    check(clEnqueueReadBuffer(queue_.get(), buffer.get(), CL_TRUE, first, bytes, data, 0, nullptr,
                              nullptr),
          "clEnqueueReadBuffer", at_);
}

void Queue::fill(const Buffer& buffer, size_t bytes, int value)
{
    if (bytes == 0) return;
    const cl_int pattern = value;
    check(clEnqueueFillBuffer(queue_.get(), buffer.get(), &pattern, sizeof pattern, 0, bytes, 0,
                              nullptr, nullptr),
          "clEnqueueFillBuffer", at_);
}

Event Queue::launch(const Kernel& kernel, size_t groups, size_t group_size)
{
    const size_t size = groups * group_size;
    cl_event event = nullptr;
    check(clEnqueueNDRangeKernel(queue_.get(), kernel.kernel_.get(), 1, nullptr, &size, &group_size,
                                 0, nullptr, &event),
          "clEnqueueNDRangeKernel", kernel.at_);
    Event launched;
    launched.event_ = Handle<cl_event, clReleaseEvent>(event);
    launched.at_ = kernel.at_;
    return launched;
}

void Queue::flush() { check(clFlush(queue_.get()), "clFlush", at_); }

void Queue::finish() { check(clFinish(queue_.get()), "clFinish", at_); }

Context::Context(const Device& device) : device_(device), at_(device.name())
{
    const cl_context_properties properties[] = {
        CL_CONTEXT_PLATFORM, reinterpret_cast<cl_context_properties>(device.platform()), 0};
    const cl_device_id id = device.id();
    cl_int status = CL_SUCCESS;
    context_ = Handle<cl_context, clReleaseContext>(
        clCreateContext(properties, 1, &id, nullptr, nullptr, &status));
    check(status, "clCreateContext", at_);
}

Queue Context::queue() const
{
    cl_int status = CL_SUCCESS;
    Queue queue;
    queue.queue_ = Handle<cl_command_queue, clReleaseCommandQueue>(
        clCreateCommandQueue(context_.get(), device_.id(), CL_QUEUE_PROFILING_ENABLE, &status));
    queue.at_ = at_;
    check(status, "clCreateCommandQueue", at_);
    return queue;
}

Buffer Context::buffer(size_t bytes, const std::string& name) const
{
    cl_int status = CL_SUCCESS;
    Buffer buffer;
    buffer.bytes_ = bytes;
    buffer.memory_ = Handle<cl_mem, clReleaseMemObject>(clCreateBuffer(
        context_.get(), CL_MEM_READ_WRITE, std::max<size_t>(bytes, 16), nullptr, &status));
    check(status, "clCreateBuffer", at_ + ", " + name + " (" + std::to_string(bytes) + " bytes)");
    return buffer;
}

Program Context::build(const std::string& source, const std::string& options,
                       const std::string& name) const
{
    const char* text = source.data();
    const size_t bytes = source.size();
    cl_int status = CL_SUCCESS;
    Program program;
    program.at_ = at_ + ", program " + name;
    program.device_ = device_.id();
    program.program_ = Handle<cl_program, clReleaseProgram>(
        clCreateProgramWithSource(context_.get(), 1, &text, &bytes, &status));
    check(status, "clCreateProgramWithSource", program.at_);
    const cl_device_id device = device_.id();
    status = clBuildProgram(program.program_.get(), 1, &device, options.c_str(), nullptr, nullptr);
    if (status != CL_SUCCESS)
        check(status, "clBuildProgram",
              program.at_ + " (" + options + "):\n" + build_log(program.program_.get(), device) +
                  "\n" + program.at_);
    return program;
}

std::optional<Program> Context::load(const std::string& binary, const std::string& options,
                                     const std::string& name) const
{
    const auto* bytes = reinterpret_cast<const unsigned char*>(binary.data());
    const size_t size = binary.size();
    const cl_device_id device = device_.id();
    cl_int status = CL_SUCCESS;
    Program program;
    program.at_ = at_ + ", program " + name;
    program.device_ = device;
    program.program_ = Handle<cl_program, clReleaseProgram>(
        clCreateProgramWithBinary(context_.get(), 1, &device, &size, &bytes, nullptr, &status));
    if (status != CL_SUCCESS) return std::nullopt;
    status = clBuildProgram(program.program_.get(), 1, &device, options.c_str(), nullptr, nullptr);
    if (status != CL_SUCCESS) return std::nullopt;
    return program;
}

}  // namespace diptych::opencl
