#include "backends/opencl_programs.hpp"

#include "backends/kernel_sources.hpp"
#include "backends/opencl_memory.hpp"
#include "backends/sha256.hpp"
#include "backends/textures/native_stage.hpp"
#include "backends/textures/texture_source.hpp"

#include <algorithm>
#include <cctype>
#include <future>
#include <stdexcept>

namespace diptych {
namespace {

// A fault's name becomes part of the options: letters only.
std::string fault_option(const std::string& fault)
{
    const bool is_word = std::all_of(fault.begin(), fault.end(),
                                     [](unsigned char c) { return std::isalpha(c) || c == '_'; });
    if (!is_word) throw std::runtime_error("opencl: \"" + fault + "\" is no name of a fault");
    return " -D FAULT=FAULT_" + (fault.empty() ? "none" : fault);
}

std::string source_for(Stage stage, const BackendOptions& options, const SceneData& scene)
{
    std::string source = kernel_source(stage);
    if (stage == STAGE_evaluate_textures)
        source =
            opencl_texture_program(scene, source, {options.generated_dir, options.use_generated});
    const std::string exact = "FP_CONTRACT OFF";
    const size_t at = source.find(exact);
    if (options.fast_math && at != std::string::npos)
        source.replace(at, exact.size(), "FP_CONTRACT ON");
    return source;
}

std::string cache_key(const DeviceInfo& device, const std::string& options,
                      const std::string& source)
{
    Sha256 hash;
    for (const std::string& part :
         {source, options, device.name, device.driver, device.version, device.platform,
          device.device.platform_text(CL_PLATFORM_VERSION)}) {
        hash.add(std::to_string(part.size()) + ":");
        hash.add(part);
    }
    return hash.finish();
}

struct Built {
    std::optional<opencl::Program> program;
    std::string key;
    std::string new_binary;  // to be stored; empty when it came from the cache
};

Built build(const opencl::Context& context, const DeviceInfo& device, const std::string& source,
            const std::string& options, const std::string& name, const ProgramCache& cache)
{
    Built built;
    built.key = cache_key(device, options, source);
    if (const std::optional<std::string> binary = cache.load(built.key))
        built.program = context.load(*binary, options, name);
    if (!built.program) {
        built.program = context.build(source, options, name);
        built.new_binary = built.program->binary();
    }
    return built;
}

Built build_stage(const opencl::Context& context, const DeviceInfo& device, Stage stage,
                  const BackendOptions& options, const SceneData& scene, const ProgramCache& cache)
{
    return build(context, device, source_for(stage, options, scene),
                 program_options(device, options, scene), stage_names[stage], cache);
}

void store(const Built& built, Stage stage, ProgramCache& cache)
{
    if (built.new_binary.empty()) return;
    if (stage == STAGE_evaluate_textures) count_texture_compilation();
    cache.store(built.key, built.new_binary);
}

}  // namespace

std::string program_options(const DeviceInfo& device, const BackendOptions& options,
                            const SceneData& scene)
{
    std::string text = "-cl-std=CL1.2 -D EFFECTS=" + std::to_string(scene.effects) +
                       " -D GROUP_SIZE=" + std::to_string(device.group_size) +
                       " -D PAGE_SHIFT=" + std::to_string(page_shift(device, scene));
    text += fault_option(options.plant_fault);
    if (options.fast_math)
        text += " -cl-fast-relaxed-math -cl-mad-enable";
    else if (device.is_exact)
        text += " -cl-fp32-correctly-rounded-divide-sqrt";
    return text;
}

ProgramSet build_programs(const opencl::Context& context, const DeviceInfo& device,
                          const BackendOptions& options, const SceneData& scene,
                          ProgramCache& cache)
{
    const unsigned effects = scene.effects;
    // one after the other, for drivers whose compiler does not stand threads (Oclgrind)
    const auto how = options.threads == 1 ? std::launch::deferred : std::launch::async;
    std::array<std::future<Built>, STAGE_COUNT> jobs;
    for (int k = 0; k < STAGE_COUNT; ++k) {
        const Stage stage = Stage(k);
        if (!is_active(stage, effects)) continue;
        jobs[k] = std::async(
            how, [&, stage] { return build_stage(context, device, stage, options, scene, cache); });
    }
    ProgramSet set;
    for (int k = 0; k < STAGE_COUNT; ++k) {
        if (!jobs[k].valid()) continue;
        Built built = jobs[k].get();
        ++(built.new_binary.empty() ? set.from_cache : set.compiled);
        store(built, Stage(k), cache);
        set.programs[k] = std::move(built.program);
    }
    return set;
}

std::optional<std::string>
verbose_texture_log(const DeviceInfo& device, const BackendOptions& options, const SceneData& scene)
{
    if (device.device.text(CL_DEVICE_VENDOR).find("NVIDIA") == std::string::npos)
        return std::nullopt;
    const Stage stage = STAGE_evaluate_textures;
    return opencl::Context(device.device)
        .build(source_for(stage, options, scene),
               program_options(device, options, scene) + " -cl-nv-verbose", stage_names[stage])
        .log();
}

opencl::Program build_texture_program(const opencl::Context& context, const DeviceInfo& device,
                                      const BackendOptions& options, const SceneData& scene,
                                      ProgramCache& cache)
{
    const Stage stage = STAGE_evaluate_textures;
    Built built = build_stage(context, device, stage, options, scene, cache);
    store(built, stage, cache);
    return std::move(*built.program);
}

}  // namespace diptych
