// The shared mathematics over arrays, compiled twice from one source: step by step and vectorised.
#pragma once

#include <cstdint>

using FunctionLoop = void(const float* a, const float* b, std::uint32_t* out, int count);

struct NamedLoop {
    const char* name;
    FunctionLoop* run;
};

// One entry per row of shared_functions.h, in that order.
namespace loops_debug {
extern const NamedLoop loops[];
extern const int loop_count;
}  // namespace loops_debug
namespace loops_vector {
extern const NamedLoop loops[];
extern const int loop_count;
}  // namespace loops_vector
