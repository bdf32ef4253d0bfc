// What compilers for GPUs print of the texture stage, as the cost card reads it.
#include "host/commands/texture_cost.hpp"

#include <gtest/gtest.h>

using namespace diptych;

namespace {

// Of a kernel and of a function that was not inlined, in the words of several versions.
const std::string verbose_log = R"(
ptxas info    : 0 bytes gmem, 144 bytes cmem[3]
ptxas info    : Compiling entry function 'evaluate_textures' for 'sm_86'
ptxas info    : Function properties for evaluate_textures
ptxas         .     272 bytes stack frame, 16 bytes spill stores, 24 bytes spill loads
ptxas info    : Used 64 registers, used 0 barriers, 408 bytes cmem[0], 12 bytes cmem[2]
ptxas info    : Function properties for t0_fbm3
    96 bytes stack frame, 40 bytes spill stores, 44 bytes spill loads
ptxas info    : Used 8 registers, 40 bytes cmem[0]
)";

TEST(TextureCost, ReadsWhatPtxasPrints)
{
    const DeviceCost cost = ptxas_cost("sm_86", verbose_log);
    EXPECT_EQ(cost.target, "sm_86");
    EXPECT_EQ(cost.missing, "");
    EXPECT_EQ(cost.registers, 64);
    EXPECT_EQ(cost.stack_bytes, 272);
    EXPECT_EQ(cost.spill_bytes, 40);
}

TEST(TextureCost, ALogWithoutRegistersIsNoMeasurement)
{
    for (const char* log : {"", "\n", "warning: option -cl-nv-verbose is ignored\n"})
        EXPECT_EQ(ptxas_cost("sm_86", log).missing, "the compiler says nothing of registers");
}

}  // namespace
