// The kernel set of faulty/platform.h.
#pragma once

#include "kernels_cpu/kernels.hpp"

namespace diptych::kernels_faulty {
extern const KernelSet set;
}
