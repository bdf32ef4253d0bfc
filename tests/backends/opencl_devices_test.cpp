#include "backends/opencl_devices.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

using namespace diptych;

namespace {

std::string message_for(const std::string& choice)
{
    try {
        pick_opencl_device(choice);
    } catch (const std::runtime_error& error) {
        return error.what();
    }
    return "";
}

TEST(OpenclDevices, AreNumberedAndDescribed)
{
    int index = 0;
    for (const DeviceInfo& device : list_opencl_devices()) {
        EXPECT_EQ(device.index, index++);
        EXPECT_NE(device.name, "");
        EXPECT_EQ(device.version.rfind("OpenCL ", 0), 0u);
        EXPECT_GT(device.memory_bytes, 0u);
        EXPECT_GT(device.largest_allocation, 0u);
        EXPECT_EQ(device.is_usable, device.why_not.empty());
    }
}

TEST(OpenclDevices, ArePickedByNumberAndByPartOfTheName)
{
    for (const DeviceInfo& device : list_opencl_devices()) {
        if (!device.is_usable) continue;
        EXPECT_EQ(pick_opencl_device(std::to_string(device.index)).name, device.name);
        EXPECT_EQ(pick_opencl_device(device.name.substr(2)).name, device.name);
        EXPECT_NO_THROW(pick_opencl_device(""));
    }
}

TEST(OpenclDevices, ThatDoNotExistAreRefusedWithAdvice)
{
    const std::string message = message_for("no such device");
    if (list_opencl_devices().empty())
        EXPECT_NE(message.find("pocl-opencl-icd"), std::string::npos);
    else
        EXPECT_NE(message.find("there are: 0 ("), std::string::npos) << message;
    EXPECT_NE(message_for("9999"), "");
    if (const std::string cpu = message_for("cpu"); !cpu.empty()) {
        EXPECT_NE(cpu.find("--backend cpu"), std::string::npos) << cpu;
    }
    EXPECT_NE(message_for("99999999999999999999"), "");
}

}  // namespace
