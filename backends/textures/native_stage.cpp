#include "backends/textures/native_stage.hpp"

#include "backends/program_cache.hpp"
#include "backends/sha256.hpp"
#include "backends/textures/scratch_folder.hpp"
#include "backends/textures/stage_headers.hpp"
#include "backends/textures/subprocess.hpp"
#include "backends/textures/texture_source.hpp"

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <dlfcn.h>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <unistd.h>

namespace diptych {
namespace {

namespace fs = std::filesystem;

constexpr const char* entry_name = "diptych_evaluate_textures";
constexpr const char* watch_name = "diptych_watch_textures";
std::atomic<unsigned long> compilations{0};

void write_text(const fs::path& file, const std::string& text)
{
    fs::create_directories(file.parent_path());
    std::ofstream out(file, std::ios::binary);
    out << text;
    out.close();
    if (!out.good())
        throw std::runtime_error(file.string() +
                                 ": cannot be written; free the disk, or set "
                                 "DIPTYCH_CACHE_DIR to a folder that can be written");
}

// What the compiler is and what -march=native means to it.
std::string compiler()
{
    const char* chosen = std::getenv("DIPTYCH_CXX");
    if (chosen && *chosen) {
        const std::string found = find_program(chosen);
        if (found.empty())
            throw std::runtime_error("DIPTYCH_CXX: " + std::string(chosen) +
                                     ": no such program; name a C++20 compiler, or unset it");
        return found;
    }
    for (const char* name : {"g++", "c++", "clang++"})
        if (const std::string found = find_program(name); !found.empty()) return found;
    throw std::runtime_error("procedural textures: no C++ compiler (g++, c++ or clang++) on the "
                             "PATH, and this backend needs one; install it, set DIPTYCH_CXX, or "
                             "use --backend opencl");
}

std::string processor()
{
    std::ifstream info("/proc/cpuinfo");
    std::string model, flags;
    for (std::string line; std::getline(info, line) && (model.empty() || flags.empty());) {
        if (line.starts_with("model name")) model = line;
        if (line.starts_with("flags") || line.starts_with("Features")) flags = line;
    }
    return model + flags;
}

// g++'s jump threading takes loops apart that it would else have put into lanes (fbm, worley);
// clang knows no such flag.
void keep_loops_whole(const std::string& program, std::vector<std::string>& flags)
{
    const char* flag = "-fno-thread-jumps";
    if (run_program({program, flag, "-E", "-x", "c", "/dev/null"}).exit_code == 0)
        flags.push_back(flag);
}

// As kernels_cpu/CMakeLists.txt compiles the kernel sets.
std::vector<std::string> flags_for(const NativeStageOptions& options)
{
    const bool is_vector = options.kind == NativeStageKind::vector;
    const bool is_double = options.kind == NativeStageKind::reference;
    std::vector<std::string> flags = {"-std=c++20",
                                      "-shared",
                                      "-fPIC",
                                      "-w",
                                      "-fvisibility=hidden",
                                      "-fno-exceptions",
                                      "-fno-rtti",
                                      "-ffp-contract=off",
                                      "-fno-math-errno",
                                      "-fno-trapping-math",
                                      "-fwrapv",
                                      "-fno-strict-aliasing",
                                      "-fopenmp-simd",
                                      std::string("-DVECTORISED=") +
                                          (is_vector && !options.is_debug ? "1" : "0"),
                                      std::string("-DDIALECT_") + (is_double ? "double" : "float")};
    if (options.kind == NativeStageKind::silent) {
        flags.insert(flags.end(), {"-O1", "-DALWAYS_INLINE="});
        return flags;
    }
    flags.push_back("-g");
    if (options.is_debug) {
        flags.insert(flags.end(), {"-O0", "-DALWAYS_INLINE="});
        return flags;
    }
    flags.push_back("-DALWAYS_INLINE=__attribute__((always_inline))");
    // Where a value lies at each instruction is a quarter of g++'s work and little use in lanes:
    // debuggers run the scalar stage. Lines and names stay.
    if (is_vector)
        flags.insert(flags.end(), {"-O3", "-march=native", "-fno-var-tracking"});
    else
        flags.insert(flags.end(), {"-O2", "-fno-tree-vectorize"});
    return flags;
}

struct Sources {
    std::string functions;
    std::string key;  // of everything that goes into the object
};

fs::path cache_folder()
{
    const fs::path folder = ProgramCache::default_folder();
    return folder.empty() ? fs::temp_directory_path() / ("diptych-" + std::to_string(getuid()))
                          : folder;
}

std::string key_of(const std::string& program, const std::vector<std::string>& flags,
                   const std::string& functions)
{
    Sha256 hash;
    const auto add = [&](const std::string& part) {
        hash.add(std::to_string(part.size()) + ":");
        hash.add(part);
    };
    add(program);
    std::error_code error;
    add(std::to_string(fs::file_size(program, error)));
    add(std::to_string(fs::last_write_time(program, error).time_since_epoch().count()));
    add(processor());
    for (const std::string& flag : flags) add(flag);
    for (const StageHeader* header = stage_headers; header->path; ++header) add(header->text());
    add(functions);
    return hash.finish();
}

// The object's own digest lies beside it: a file cut short must not be loaded.
bool is_whole(const fs::path& object)
{
    Sha256 hash;
    const std::string bytes = text_of(object);
    if (bytes.empty()) return false;
    hash.add(bytes);
    return hash.finish() == text_of(object.string() + ".sha256");
}

void write_headers(const fs::path& folder)
{
    for (const StageHeader* header = stage_headers; header->path; ++header)
        write_text(folder / header->path, header->text());
}

void compile(const std::string& program, std::vector<std::string> flags, const fs::path& folder,
             const fs::path& object, const NativeStageOptions& options)
{
    const fs::path root = folder / "headers";
    const char* dialect = options.kind == NativeStageKind::reference ? "as_double" : "as_cpp";
    const fs::path unfinished = object.string() + "." + std::to_string(getpid()) + ".tmp";
    std::vector<std::string> command = {program};
    command.insert(command.end(), flags.begin(), flags.end());
    command.insert(command.end(),
                   {"-I" + root.string(), "-I" + (root / "common" / dialect).string(),
                    "-I" + folder.string(), "-DTEXTURE_FUNCTIONS_FILE=\"functions.hpp\"", "-o",
                    unfinished.string(), (root / "kernels_cpu/texture_stage.cpp").string()});
    const Finished done = run_program(command);
    count_texture_compilation();
    if (done.exit_code != 0) {
        std::error_code ignored;
        fs::remove(unfinished, ignored);
        throw std::runtime_error("procedural textures: " + program +
                                 " refuses the generated code (" +
                                 (folder / "functions.hpp").string() + "):\n" + done.output);
    }
    Sha256 hash;
    hash.add(text_of(unfinished));
    write_text(object.string() + ".sha256", hash.finish());
    fs::rename(unfinished, object);
}

}  // namespace

unsigned long texture_compilations() { return compilations; }
void count_texture_compilation() { ++compilations; }

NativeStage::NativeStage(const SceneData& scene, const NativeStageOptions& options)
{
    const std::string program = compiler();
    std::vector<std::string> flags = flags_for(options);
    if (options.kind == NativeStageKind::vector && !options.is_debug)
        keep_loops_whole(program, flags);
    const std::string functions =
        cpp_texture_functions(scene, {options.generated_dir, options.use_generated});
    const std::string key = key_of(program, flags, functions);
    const fs::path folder = cache_folder() / "textures" / key.substr(0, 32);
    const fs::path object = folder / "stage.so";
    if (!is_whole(object)) {
        write_headers(folder / "headers");
        write_text(folder / "functions.hpp", functions);
        compile(program, flags, folder, object, options);
        was_compiled_ = true;
    }
    library_ = dlopen(object.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (!library_)
        throw std::runtime_error("procedural textures: " + object.string() + ": " + dlerror() +
                                 "; delete it, so that it is made again");
    kernels_.evaluate = reinterpret_cast<StageLoop>(dlsym(library_, entry_name));
    if (!kernels_.evaluate)
        throw std::runtime_error("procedural textures: " + object.string() +
                                 " lacks its entry; delete it, so that it is made again");
    kernels_.watch = reinterpret_cast<decltype(kernels_.watch)>(dlsym(library_, watch_name));
    std::ranges::copy(texture_planes(scene), kernels_.planes);
}

NativeStage::~NativeStage()
{
    if (library_) dlclose(library_);
}

}  // namespace diptych
