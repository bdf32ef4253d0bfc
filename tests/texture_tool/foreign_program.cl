// The same texture in somebody's own kernel.
#include "platform.h"

#include "common/user_language/as_opencl/user_language.h"

// clang-format off
#include "tests/texture_tool/foreign_hooks.h"
#include "common/user_language/as_vectors/arguments.h"
#include TEXTURE_TEXT
// clang-format on

__kernel void evaluate(__global float4* results, __global int2* faults)
{
    TextureContext tx = foreign_context((int)get_global_id(0));
    results[get_global_id(0)] = texture_entry(&tx, 0);
    faults[get_global_id(0)] = (int2)(tx.clamped, tx.fault_line);
}
