// Several devices as one backend: what renders with it knows nothing of them.
#pragma once

#include "backends/backend.hpp"

namespace diptych {

// The items of a dispatch are shared among the devices, faster ones taking more; results lie where
// their items do, whoever rendered them. A device that throws in render() is dropped: `notify` gets
// a line that names it and the reason, the others render its items; when none is left, render()
// throws. upload() and plan() throw when one of the devices does. An update that the first device
// refuses changes none; one that takes it and another does not costs the other its place.
// Devices that complete the scene with trees come before those that read it in place.
std::unique_ptr<Backend> make_device_group(std::vector<std::unique_ptr<Backend>> devices,
                                           std::function<void(const std::string&)> notify);

}  // namespace diptych
