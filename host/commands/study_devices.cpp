#include "host/commands/study_devices.hpp"

#include "backends/textures/scratch_folder.hpp"
#include "backends/textures/texture_arms.hpp"
#include "backends/textures/texture_tool.hpp"
#include "host/commands/texture_cost.hpp"
#include "host/commands/texture_file.hpp"
#include "host/scene/environment.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <fstream>
#include <map>

namespace diptych {
namespace {

constexpr int few_registers = 64;

struct DeviceRow {
    std::string name;
    TextureArm arm;
};

const std::vector<DeviceRow> arms = {
    {"interpreter, occlusion as stage", {}},
    {"inlined constants, occlusion as stage", {.pastes_arguments = true}},
    {"interpreter, occlusion inline", {.traces_inside = true}},
    {"inlined constants, occlusion inline", {.pastes_arguments = true, .traces_inside = true}},
};

void print_heads(const std::string& what)
{
    fmt::print("\n{}\n  {:<38} {:<7} {:>9} {:>10} {:>7} {:>7} {:>9} {:>9}\n", what, "", "target",
               "limit", "registers", "stack", "spills", "code", "compiled");
}

void print_cost(const std::string& name, const DeviceCost& cost, bool is_limited)
{
    const std::string limit = is_limited ? std::to_string(few_registers) : "none";
    if (!cost.missing.empty()) {
        fmt::print("  {:<38} {:<7} {:>9} not measured: {}\n", name, cost.target, limit,
                   cost.missing);
    } else {
        fmt::print("  {:<38} {:<7} {:>9} {:>10} {:>7} {:>7} {:>9} {:>7.2f} s\n", name, cost.target,
                   limit, cost.registers, cost.stack_bytes, cost.spill_bytes, cost.code_bytes,
                   cost.seconds);
    }
    std::fflush(stdout);
}

void print_costs(const std::string& name, const DeviceCosts& costs)
{
    for (const DeviceCost& cost : costs.free) print_cost(name, cost, false);
    for (const DeviceCost& cost : costs.limited) print_cost(name, cost, true);
}

// A float function of `count` arguments, each with a weight of its own.
std::string sum_of(int count)
{
    std::string parameters, terms;
    for (int k = 0; k < count; ++k) {
        parameters += fmt::format("{}float a{}", k > 0 ? ", " : "", k);
        terms += fmt::format("{}a{} * {:.4f}f", k > 0 ? " + " : "", k, 1.0 / (k + 2));
    }
    return fmt::format("float sum({})\n{{\n    return {};\n}}\n", parameters, terms);
}

// One noise, whose result all arguments of a sum read.
SceneData shared_noise(int count)
{
    const ScratchFolder folder;
    std::ofstream(folder / "sum.c") << sum_of(count);
    SceneBuilder scene;
    const TextureFile noise_file = find_texture_file("fbm");
    TextureFunction noise = translate_file(noise_file);
    const int node = [&] {
        TextureNode made = node_of(noise, noise_file, {}, scene);
        made.function = scene.add_texture_function(std::move(noise));
        return scene.add_texture_node(std::move(made));
    }();
    TextureNode sum;
    sum.name = "sum";
    sum.function =
        scene.add_texture_function(translate_texture({folder / "sum.c", "sum.c", "sum", "t1"}));
    for (int k = 0; k < count; ++k) sum.arguments[fmt::format("a{}", k)] = {.node = node};
    MaterialInput material{.specular = 0};
    material.base_texture.node = scene.add_texture_node(std::move(sum));
    scene.place(
        scene.add_mesh(quad_mesh({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, scene.add_material(material))));
    scene.set_environment(neutral_sky());
    return scene.finish();
}

// `name`, its two arms on sm_80 with 64 registers: stack frames, ours and all inlined.
void print_stack_sign(const std::string& name, const DeviceCosts& own, const DeviceCosts& inlined,
                      int paper_own, int paper_inlined)
{
    for (size_t k = 0; k < own.limited.size(); ++k) {
        const DeviceCost& a = own.limited[k];
        const DeviceCost& b = inlined.limited[k];
        if (!a.missing.empty() || !b.missing.empty()) continue;
        fmt::print("  {:<7} {}, {}: smaller stack frame than all inlined (paper: {} against {} "
                   "bytes): {} against {} bytes\n",
                   a.stack_bytes < b.stack_bytes ? "holds" : "FAILED", name, a.target, paper_own,
                   paper_inlined, a.stack_bytes, b.stack_bytes);
        if (a.target == "sm_80")
            fmt::print(
                "  {:<7} goal: {} below {} bytes: {} with {} registers, {} without a limit\n",
                a.stack_bytes < paper_own && own.free[k].stack_bytes < paper_own ? "holds"
                                                                                 : "FAILED",
                name, paper_own, a.stack_bytes, few_registers, own.free[k].stack_bytes);
    }
}

}  // namespace

void print_study_devices(const StudyScenes& scenes)
{
    print_heads("the texture stage as compilers for GPUs see it, with the same flags");
    std::vector<DeviceCosts> rust, scratches;
    for (const DeviceRow& row : arms) {
        SceneData rust_scene = scenes.scene(HelmetMaterial::rust);
        make_texture_arm(rust_scene, row.arm);
        rust.push_back(device_costs(rust_scene, few_registers));
        print_costs("rust, " + row.name, rust.back());
    }
    for (size_t k = 0; k < 2; ++k) {
        SceneData scratched = scenes.scene(HelmetMaterial::scratches);
        make_texture_arm(scratched, arms[k].arm);
        scratches.push_back(device_costs(scratched, few_registers));
        print_costs(k == 0 ? "scratches, interpreter" : "scratches, inlined constants",
                    scratches.back());
    }
    if (!rust[0].limited.empty()) {
        print_stack_sign("rust", rust[0], rust[3], 464, 604);
        print_stack_sign("scratches", scratches[0], scratches[1], 336, 412);
    }
    print_heads("one noise (fbm) that so many arguments read");
    for (const int count : {1, 2, 4, 8, 16}) {
        for (size_t k = 0; k < 2; ++k) {
            SceneData scene = shared_noise(count);
            make_texture_arm(scene, arms[k].arm);
            print_costs(
                fmt::format("{} x, {}", count, k == 0 ? "interpreter" : "inlined constants"),
                device_costs(scene, few_registers));
        }
    }
}

}  // namespace diptych
