// The native stages of a CPU that walks the same BVH as OpenCL. Included into the namespace of a
// kernel set.
#pragma once

#include "common/stages/intersect.h"
#include "common/stages/occlusion.h"
