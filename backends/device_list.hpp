// --device with several entries: "0,1,cpu" or "0/2".
#pragma once

#include "backends/backend.hpp"

namespace diptych {

struct DeviceEntry {
    std::string choice;  // an OpenCL device, see pick_opencl_device, or "cpu"
    int parts = 1;       // equal ones that it is divided into
};

// Whether the text asks for more than one device: it has a comma or ends as "/2".
bool is_device_list(const std::string& text);

// Throws std::runtime_error for an empty or double entry and a division that makes no sense.
std::vector<DeviceEntry> parse_device_list(const std::string& text);

// What such devices are called in pictures and checkpoints: "opencl", or "cpu+opencl".
std::string backend_of_devices(const std::vector<DeviceEntry>& entries);

// All of options.device as one backend. Throws where one of them cannot be used or comes twice.
std::unique_ptr<Backend> make_devices(const BackendOptions& options);

}  // namespace diptych
