// Registers, stack and code of the texture stage on GPUs that need not be there: clang with libclc
// compiles it, ptxas of a CUDA toolkit and clang's assembly say what it takes. As ci/bench_kernels
// does for all stages.
#include "host/commands/texture_cost.hpp"

#ifdef DIPTYCH_WITH_OPENCL

#include "backends/kernel_sources.hpp"
#include "backends/opencl_programs.hpp"
#include "backends/textures/scratch_folder.hpp"
#include "backends/textures/subprocess.hpp"
#include "backends/textures/texture_source.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <stdexcept>
#include <unistd.h>

namespace diptych {
namespace {

namespace fs = std::filesystem;

std::string first_program(const std::vector<std::string>& names)
{
    for (const std::string& name : names)
        if (const std::string found = find_program(name); !found.empty()) return found;
    return "";
}

std::string clang()
{
    std::vector<std::string> names = {"clang"};
    for (int version = 22; version >= 14; --version)
        names.push_back("clang-" + std::to_string(version));
    return first_program(names);
}

std::string library(const std::string& name)
{
    std::vector<std::string> folders = {"/usr/lib/clc", "/usr/share/clc", "/usr/local/lib/clc",
                                        "/usr/local/share/clc"};
    for (int version = 22; version >= 14; --version)
        folders.push_back(fmt::format("/usr/lib/llvm-{}/share/clc", version));
    for (const std::string& folder : folders)
        if (fs::exists(folder + "/" + name)) return folder + "/" + name;
    return "";
}

Finished compile(const std::string& source, const std::string& out, unsigned effects,
                 const std::string& bitcode, const std::vector<std::string>& target)
{
    std::vector<std::string> command = {clang(),
                                        "-x",
                                        "cl",
                                        "-cl-std=CL1.2",
                                        "-Xclang",
                                        "-finclude-default-header",
                                        "-O3",
                                        "-w",
                                        "-S",
                                        "-DFAULT=FAULT_none",
                                        "-DGROUP_SIZE=64",
                                        "-DPAGE_SHIFT=0",
                                        "-DEFFECTS=" + std::to_string(effects) + "u",
                                        "-Xclang",
                                        "-mlink-builtin-bitcode",
                                        "-Xclang",
                                        bitcode};
    command.insert(command.end(), target.begin(), target.end());
    command.insert(command.end(), {source, "-o", out});
    return run_program(command);
}

// The first group of the pattern as a number, the largest of all matches; 0 when there is none.
int largest(const std::string& text, const char* pattern)
{
    int value = 0;
    const std::regex expression(pattern);
    for (std::sregex_iterator at(text.begin(), text.end(), expression), end; at != end; ++at)
        value = std::max(value, std::stoi((*at)[1]));
    return value;
}

// The size of the section of machine code in what ptxas writes, an ELF file of 64 bits.
int code_bytes(const std::string& elf)
{
    const auto word = [&](size_t at, int bytes) {
        std::uint64_t value = 0;
        for (int k = bytes - 1; k >= 0; --k)
            value =
                value << 8 | (at + size_t(k) < elf.size() ? std::uint8_t(elf[at + size_t(k)]) : 0u);
        return size_t(value);
    };
    if (elf.size() < 64) return 0;
    const size_t table = word(40, 8), entry = word(58, 2), count = word(60, 2);
    const size_t names = word(table + entry * word(62, 2) + 24, 8);
    size_t bytes = 0;
    for (size_t k = 0; k < count && table + (k + 1) * entry <= elf.size(); ++k) {
        const size_t section = table + k * entry;
        const size_t name = names + word(section, 4);
        if (name < elf.size() && elf.compare(name, 6, ".text.") == 0)
            bytes += word(section + 32, 8);
    }
    return int(bytes);
}

double seconds_since(std::chrono::steady_clock::time_point start)
{
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

// ptxas on what clang wrote to `ptx`; `limit` is its flag for registers, or empty.
DeviceCost assembled(const std::string& assembler, const std::string& ptx, const std::string& limit,
                     const ScratchFolder& folder)
{
    const std::string cubin = folder / "kernel.cubin";
    std::vector<std::string> command = {assembler, "-v", "-arch=sm_80", ptx, "-o", cubin};
    if (!limit.empty()) command.push_back(limit);
    const auto start = std::chrono::steady_clock::now();
    const Finished done = run_program(command);
    DeviceCost cost = ptxas_cost("sm_80", done.output);
    cost.seconds = seconds_since(start);
    if (done.exit_code != 0)
        cost.missing = "ptxas: " + first_line(done.output);
    else
        cost.code_bytes = code_bytes(text_of(cubin));
    return cost;
}

void nvidia(const std::string& source, unsigned effects, int most_registers,
            const ScratchFolder& folder, DeviceCosts& costs)
{
    DeviceCost missing;
    missing.target = "sm_80";
    const std::string bitcode = library("nvptx64--nvidiacl.bc");
    const std::string assembler = first_program({"ptxas", "/usr/local/cuda/bin/ptxas"});
    if (clang().empty()) missing.missing = "no clang";
    if (bitcode.empty()) missing.missing = "no libclc (Debian: libclc-14 or libclc-19)";
    if (assembler.empty()) missing.missing = "no ptxas (CUDA toolkit)";
    const std::string out = folder / "kernel.ptx";
    const auto start = std::chrono::steady_clock::now();
    if (missing.missing.empty()) {
        const Finished compiled =
            compile(source, out, effects, bitcode,
                    {"-target", "nvptx64--nvidiacl", "-Xclang", "-target-cpu", "-Xclang", "sm_80",
                     "-Xclang", "-target-feature", "-Xclang", "+ptx70"});
        if (compiled.exit_code != 0) missing.missing = "clang: " + first_line(compiled.output);
    }
    const double seconds = seconds_since(start);
    for (auto* list : {&costs.free, &costs.limited}) {
        if (list == &costs.limited && most_registers <= 0) continue;
        const std::string limit =
            list == &costs.limited ? fmt::format("-maxrregcount={}", most_registers) : "";
        list->push_back(missing.missing.empty() ? assembled(assembler, out, limit, folder)
                                                : missing);
        list->back().seconds += seconds;
    }
}

// The kernel with no more than so many vector registers.
std::string limited_source(const std::string& source, int registers)
{
    const std::string kernel = "__kernel ";
    std::string text = source;
    const size_t at = text.rfind(kernel);
    if (at != std::string::npos)
        text.insert(at + kernel.size(),
                    fmt::format("__attribute__((amdgpu_num_vgpr({}))) ", registers));
    return text;
}

DeviceCost amd(const std::string& source, unsigned effects, const ScratchFolder& folder)
{
    DeviceCost cost;
    cost.target = "gfx900";
    const std::string bitcode = library("amdgcn--amdhsa.bc");
    if (clang().empty()) cost.missing = "no clang";
    if (bitcode.empty()) cost.missing = "no libclc (Debian: libclc-14 or libclc-19)";
    if (!cost.missing.empty()) return cost;
    const std::string out = folder / "kernel.s";
    const auto start = std::chrono::steady_clock::now();
    const Finished compiled = compile(source, out, effects, bitcode,
                                      {"-target", "amdgcn--amdhsa", "-nogpulib", "-mcpu=gfx900"});
    cost.seconds = seconds_since(start);
    if (compiled.exit_code != 0) {
        cost.missing = "clang: " + first_line(compiled.output);
        return cost;
    }
    const std::string assembly = text_of(out);
    cost.registers = largest(assembly, "; NumVgprs: (\\d+)");
    cost.stack_bytes = largest(assembly, "; ScratchSize: (\\d+)");
    cost.spill_bytes = 4 * largest(assembly, "\\.vgpr_spill_count: *(\\d+)");
    cost.code_bytes = largest(assembly, "; codeLenInByte = (\\d+)");
    return cost;
}

}  // namespace

DeviceCost ptxas_cost(const std::string& target, const std::string& log)
{
    DeviceCost cost;
    cost.target = target;
    cost.registers = largest(log, "Used (\\d+) registers");
    cost.stack_bytes = largest(log, "(\\d+) bytes stack frame");
    cost.spill_bytes = largest(log, "(\\d+) bytes spill stores");
    if (cost.registers == 0) cost.missing = "the compiler says nothing of registers";
    return cost;
}

std::optional<DeviceCost> driver_cost(const SceneData& scene, const BackendOptions& options)
{
    DeviceCost cost;
    try {
        const DeviceInfo device = pick_opencl_device(options.device);
        cost.target = device.name;
        const auto log = verbose_texture_log(device, options, scene);
        if (!log) return std::nullopt;
        cost = ptxas_cost(device.name, *log);
        if (!cost.missing.empty())  // the driver's own cache keeps programs without their logs
            cost.missing += "; set CUDA_CACHE_DISABLE=1 and try again";
    } catch (const std::runtime_error& error) {
        if (cost.target.empty()) return std::nullopt;
        cost.missing = first_line(error.what());
    }
    return cost;
}

DeviceCosts device_costs(const SceneData& scene, int most_registers)
{
    const ScratchFolder folder;
    const std::string text = opencl_texture_program(scene, kernel_source(STAGE_evaluate_textures));
    const auto written = [&](const char* name, const std::string& source) {
        std::ofstream(folder / name) << source;
        return folder / name;
    };
    const std::string source = written("evaluate_textures.cl", text);
    DeviceCosts costs;
    nvidia(source, scene.effects, most_registers, folder, costs);
    costs.free.push_back(amd(source, scene.effects, folder));
    if (most_registers > 0)
        costs.limited.push_back(amd(written("limited.cl", limited_source(text, most_registers)),
                                    scene.effects, folder));
    return costs;
}

}  // namespace diptych

#else

namespace diptych {

DeviceCosts device_costs(const SceneData&, int) { return {}; }
std::optional<DeviceCost> driver_cost(const SceneData&, const BackendOptions&) { return {}; }

}  // namespace diptych

#endif
