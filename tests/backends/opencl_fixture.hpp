// Scenes for the tests of the OpenCL backend, and the devices that they run on.
#pragma once

#include "backends/backend.hpp"
#include "backends/opencl_devices.hpp"

#include <vector>

// A few coloured triangles around a lamp that lights them.
diptych::SceneData lamp_scene();

// Each work item is a block of the picture.
std::vector<WorkItem> blocks(const diptych::SceneData& scene, int first_sample = 0);

std::vector<diptych::DeviceInfo> usable_devices();

// Whether every row holds the same bits.
bool is_same(const diptych::Results& a, const diptych::Results& b);
