// LOOPS is the namespace; the flags decide what the loops become.
#include "platform.h"

#include "tests/common/function_loops.hpp"
#include "tests/common/shared_functions.h"

namespace LOOPS {

#define FUNCTION_LOOP(name, result)                                                                \
    static void loop_##name(const float* a, const float* b, std::uint32_t* out, int count)         \
    {                                                                                              \
        _Pragma("omp simd") for (int i = 0; i < count; ++i) out[i] = result_of_##name(a[i], b[i]); \
    }
SHARED_FUNCTIONS(FUNCTION_LOOP)

#define LOOP_ENTRY(name, result) {#name, loop_##name},
const NamedLoop loops[] = {SHARED_FUNCTIONS(LOOP_ENTRY)};
const int loop_count = sizeof(loops) / sizeof(loops[0]);

}  // namespace LOOPS
