// The C++ dialect with one function a little wrong: it turns the environment, as paths see it that
// leave the scene.
#pragma once

#include "common/as_cpp/platform.h"

SHARED float faulty_atan2(float y, float x) { return math_atan2(y, x) + 0.25f; }
#define math_atan2(y, x) faulty_atan2(y, x)
