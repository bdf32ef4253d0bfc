// OpenCL 1.2 as values that own what they hold. The only place that sees a cl_int: every failure
// becomes a std::runtime_error that names the call, the device and the kernel.
#pragma once

#define CL_TARGET_OPENCL_VERSION 120
#include <CL/cl.h>

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace diptych::opencl {

// Throws unless status is CL_SUCCESS. `at` says what the call was about: a device, a kernel.
void check(cl_int status, const char* call, const std::string& at);

// A reference-counted OpenCL object.
template<class Object, cl_int (*release)(Object)>
class Handle {
public:
    Handle() = default;
    explicit Handle(Object object) : object_(object) {}
    Handle(Handle&& other) noexcept : object_(std::exchange(other.object_, nullptr)) {}
    Handle& operator=(Handle&& other) noexcept
    {
        std::swap(object_, other.object_);
        return *this;
    }
    ~Handle()
    {
        if (object_) release(object_);
    }
    Object get() const { return object_; }
    explicit operator bool() const { return object_ != nullptr; }

private:
    Object object_ = nullptr;
};

// A device of one of the platforms, which live as long as the process, or a part of one, which
// lives as long as the values that name it.
class Device {
public:
    Device() = default;
    Device(cl_platform_id platform, cl_device_id id) : platform_(platform), id_(id) {}

    std::string text(cl_device_info what) const;
    std::string platform_text(cl_platform_info what) const;
    template<class Number>
    Number number(cl_device_info what) const
    {
        Number value{};
        read(what, sizeof value, &value);
        return value;
    }
    std::string name() const { return text(CL_DEVICE_NAME); }
    // Equal parts, as many as are asked for. Throws where the device cannot be divided so.
    std::vector<Device> divided(int parts) const;
    // Into how many parts it can be divided at most; 0: it cannot.
    int most_parts() const;
    cl_device_id id() const { return id_; }
    cl_platform_id platform() const { return platform_; }

private:
    void read(cl_device_info what, size_t bytes, void* value) const;

    cl_platform_id platform_ = nullptr;
    cl_device_id id_ = nullptr;
    std::shared_ptr<Handle<cl_device_id, clReleaseDevice>> part_;  // what is to be released
};

// Of all platforms, in the loader's order; empty where no platform is installed.
std::vector<Device> all_devices();

class Buffer {
public:
    Buffer() = default;
    size_t bytes() const { return bytes_; }
    cl_mem get() const { return memory_.get(); }

private:
    friend class Context;
    Handle<cl_mem, clReleaseMemObject> memory_;
    size_t bytes_ = 0;
};

class Program {
public:
    std::string binary() const;
    std::string log() const;  // what the device's compiler said

private:
    friend class Context;
    friend class Kernel;
    Handle<cl_program, clReleaseProgram> program_;
    std::string at_;
    cl_device_id device_ = nullptr;
};

// Nanoseconds on the device, once the command has ended.
class Event {
public:
    double seconds() const;

private:
    friend class Queue;
    Handle<cl_event, clReleaseEvent> event_;
    std::string at_;
};

class Kernel {
public:
    Kernel() = default;
    Kernel(const Program& program, const std::string& name);

    void set(int index, const Buffer& buffer);
    void set(int index, int value);

private:
    friend class Queue;
    void set_bytes(int index, size_t bytes, const void* value);

    Handle<cl_kernel, clReleaseKernel> kernel_;
    std::string at_;
};

// In order, with timing.
class Queue {
public:
    Queue() = default;

    // Both wait; `first`: byte of the buffer.
    void write(const Buffer& buffer, size_t bytes, const void* data, size_t first = 0);
    void read(const Buffer& buffer, size_t bytes, void* data, size_t first = 0);
    void fill(const Buffer& buffer, size_t bytes, int value);  // bytes: a multiple of 4
    Event launch(const Kernel& kernel, size_t groups, size_t group_size);
    void flush();
    void finish();

private:
    friend class Context;
    Handle<cl_command_queue, clReleaseCommandQueue> queue_;
    std::string at_;
};

class Context {
public:
    Context() = default;
    explicit Context(const Device& device);

    Queue queue() const;

    // At least one byte is allocated. `name` tells in messages what does not fit.
    Buffer buffer(size_t bytes, const std::string& name) const;

    // `name` is the program's in messages, which include the compiler's log.
    Program build(const std::string& source, const std::string& options,
                  const std::string& name) const;

    // Nothing when the driver does not take the binary.
    std::optional<Program> load(const std::string& binary, const std::string& options,
                                const std::string& name) const;

private:
    Handle<cl_context, clReleaseContext> context_;
    Device device_;
    std::string at_;
};

}  // namespace diptych::opencl
