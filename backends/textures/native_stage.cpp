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
#include <functional>
#include <future>
#include <iterator>
#include <span>
#include <stdexcept>
#include <thread>
#include <unistd.h>

namespace diptych {
namespace {

namespace fs = std::filesystem;

constexpr const char* entry_name = "diptych_evaluate_textures";
constexpr const char* watch_name = "diptych_watch_textures";
std::atomic<unsigned long> compilations{0};

constexpr int most_gibibytes = 4;  // of a compiler over one texture; 300 MiB are usual

// With the messages of a compiler, which name lines.
struct RefusedCode : std::runtime_error {
    using std::runtime_error::runtime_error;
};

struct Compiler {
    std::string program;
    int most_seconds;
};

// A name that no other thread or process has, beside the file that it becomes.
fs::path unfinished(const fs::path& file)
{
    static std::atomic<unsigned> count{0};
    return file.string() + "." + std::to_string(getpid()) + "-" + std::to_string(count++) + ".tmp";
}

// At once: who reads at the same time finds all of a text, old or new.
void write_text(const fs::path& file, const std::string& text)
{
    fs::create_directories(file.parent_path());
    const fs::path part = unfinished(file);
    std::ofstream out(part, std::ios::binary);
    out << text;
    out.close();
    if (!out.good())
        throw std::runtime_error(file.string() +
                                 ": cannot be written; free the disk, or set "
                                 "DIPTYCH_CACHE_DIR to a folder that can be written");
    fs::rename(part, file);
}

bool is_compiler_chosen()
{
    const char* chosen = std::getenv("DIPTYCH_CXX");
    return chosen && *chosen;
}

std::string compiler_program()
{
    if (is_compiler_chosen()) {
        const std::string chosen = std::getenv("DIPTYCH_CXX");
        const std::string found = find_program(chosen);
        if (found.empty())
            throw std::runtime_error("DIPTYCH_CXX: " + chosen +
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

// What g++ alone needs: its jump threading takes loops apart that it would else have put into lanes
// (fbm, worley), combining more than two instructions is half of its work on large loops (marble),
// which run no faster for it, and on some processors it shuns gathers: see
// kernels_cpu/CMakeLists.txt.
void add_flags_of_gcc(const std::string& program, std::vector<std::string>& flags)
{
    const std::vector<std::string> own = {"-fno-thread-jumps", "--param=max-combine-insns=2",
                                          "-mtune-ctrl=use_gather"};
    const auto are_known = [&](std::span<const std::string> some) {
        std::vector<std::string> command = {program, "-E", "-x", "c", "/dev/null"};
        command.insert(command.end(), some.begin(), some.end());
        return run_program(command).exit_code == 0;
    };
    const bool are_all_known = are_known(own);  // mostly: one process instead of three
    for (const std::string& flag : own)
        if (are_all_known || are_known({&flag, 1})) flags.push_back(flag);
}

// Those of the host, if it runs under any: users' code is watched too.
#ifdef DIPTYCH_SANITIZERS
const std::vector<std::string> sanitizers = {DIPTYCH_SANITIZERS, "-fno-omit-frame-pointer"};
#else
const std::vector<std::string> sanitizers = {};
#endif

bool is_in_lanes(const NativeStageOptions& options)
{
    return options.kind == NativeStageKind::vector && !options.is_debug;
}

// As kernels_cpu/CMakeLists.txt compiles the kernel sets.
std::vector<std::string> flags_for(const NativeStageOptions& options)
{
    const bool is_double = options.kind == NativeStageKind::reference;
    std::vector<std::string> flags = {"-std=c++20",
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
                                      std::string("-DDIALECT_") + (is_double ? "double" : "float")};
    flags.insert(flags.end(), sanitizers.begin(), sanitizers.end());
    if (options.kind == NativeStageKind::silent) {
        flags.insert(flags.end(), {"-O1", "-DALWAYS_INLINE="});
        return flags;
    }
    flags.push_back("-g");
    if (options.is_debug) {
        flags.insert(flags.end(), {"-O0", "-DALWAYS_INLINE="});
        return flags;
    }
    if (!sanitizers.empty()) {
        flags.insert(flags.end(), {"-O1", "-DALWAYS_INLINE="});
        return flags;
    }
    flags.push_back("-DALWAYS_INLINE=__attribute__((always_inline))");
    // Where a value lies at each instruction is a quarter of g++'s work and little use in lanes:
    // debuggers run the scalar stage. Lines and names stay.
    if (is_in_lanes(options))
        flags.insert(flags.end(), {"-O3", "-march=native", "-fno-var-tracking"});
    else
        flags.insert(flags.end(), {"-O2", "-fno-tree-vectorize"});
    return flags;
}

fs::path cache_folder()
{
    const fs::path folder = ProgramCache::default_folder();
    return folder.empty() ? fs::temp_directory_path() / ("diptych-" + std::to_string(getuid()))
                          : folder;
}

const std::string& headers_digest()
{
    static const std::string digest = [] {
        Sha256 hash;
        for (const StageHeader* header = stage_headers; header->path; ++header)
            hash.add(std::string(header->path) + ":" + header->text());
        return hash.finish().substr(0, 32);
    }();
    return digest;
}

// One call of the compiler.
struct Source {
    const char* file;  // from the root of the tree
    const char* dialect;
    std::string functions;  // TEXTURE_FUNCTIONS_FILE
    std::vector<std::string> flags;
};

// Of everything that goes into what the compiler makes.
std::string key_of(const std::string& program, const Source& source)
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
    add(source.file);
    add(source.dialect);
    for (const std::string& flag : source.flags) add(flag);
    add(headers_digest());
    add(source.functions);
    return hash.finish().substr(0, 32);
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

// The embedded sources, in a folder that all compilations share.
fs::path headers()
{
    const fs::path folder = cache_folder() / "textures" / "headers" / headers_digest();
    for (const StageHeader* header = stage_headers; header->path; ++header) {
        const std::string text = header->text();
        if (text_of(folder / header->path) != text) write_text(folder / header->path, text);
    }
    return folder;
}

// Of a program that is no compiler, or a broken one.
[[noreturn]] void fail_without_message(const std::string& program, int exit_code)
{
    const std::string what = program + ": ends " +
                             (exit_code == 0 ? "without an error, but made nothing"
                                             : "with exit code " + std::to_string(exit_code) +
                                                   " and without a message") +
                             " of the generated code; ";
    throw std::runtime_error(is_compiler_chosen()
                                 ? "DIPTYCH_CXX: " + what + "name a C++20 compiler, or unset it"
                                 : "procedural textures: " + what +
                                       "repair it, or name another C++20 compiler by "
                                       "DIPTYCH_CXX");
}

// Runs a compiler's command, and keeps what it makes with its digest.
void make(std::vector<std::string> command, int most_seconds, const fs::path& object,
          const fs::path& functions)
{
    fs::create_directories(object.parent_path());
    const fs::path part = unfinished(object);
    command.insert(command.end(), {"-o", part.string()});
    const Finished done = run_program_within(most_seconds, most_gibibytes, command);
    const std::string made = done.exit_code == 0 ? text_of(part) : "";
    if (made.empty()) {
        std::error_code ignored;
        fs::remove(part, ignored);
        if (done.seconds > 0.9 * most_seconds)
            throw std::runtime_error("procedural textures: " + command[0] + " was stopped after " +
                                     std::to_string(most_seconds) + " s over " +
                                     functions.string() + "; make that texture's code shorter");
        if (done.exit_code == 0 || done.output.empty())
            fail_without_message(command[0], done.exit_code);
        throw RefusedCode("procedural textures: " + command[0] + " refuses the generated code (" +
                          functions.string() + "):\n" + done.output);
    }
    Sha256 hash;
    hash.add(made);
    write_text(object.string() + ".sha256", hash.finish());
    fs::rename(part, object);
}

void compile(const Compiler& compiler, const Source& source, const fs::path& root,
             const fs::path& object)
{
    const fs::path functions = object.parent_path() / "functions.hpp";
    write_text(functions, with_generated_lines_of(source.functions, functions));
    std::vector<std::string> command = {compiler.program};
    command.insert(command.end(), source.flags.begin(), source.flags.end());
    command.insert(command.end(),
                   {"-I" + root.string(), "-I" + (root / "common" / source.dialect).string(),
                    "-I" + object.parent_path().string(),
                    "-DTEXTURE_FUNCTIONS_FILE=\"functions.hpp\"", (root / source.file).string()});
    make(command, compiler.most_seconds, object, functions);
}

// Calls work(0) to work(count - 1), as many at a time as there are processors; throws what one
// threw.
void for_each_at_once(size_t count, const std::function<void(size_t)>& work)
{
    std::atomic<size_t> next{0};
    const auto take = [&] {
        for (size_t k = next++; k < count; k = next++) work(k);
    };
    std::vector<std::future<void>> others;
    const size_t threads = std::max(1u, std::thread::hardware_concurrency());
    for (size_t k = 1; k < std::min(count, threads); ++k)
        others.push_back(std::async(std::launch::async, take));
    take();
    for (std::future<void>& other : others) other.get();
}

// The stage in lanes, an object for each loop: those of functions that were not edited are there.
std::vector<Source> sources_in_lanes(const SceneData& scene, const CppTextures& textures,
                                     const std::vector<std::string>& flags)
{
    std::vector<Source> sources;
    for (size_t k = 0; k < textures.functions.size(); ++k)
        for (const char* is_uniform : {"1", "0"}) {
            sources.push_back(
                {"kernels_cpu/texture_loop.cpp", "as_cpp", textures.functions[k], flags});
            std::vector<std::string>& own = sources.back().flags;
            own.push_back("-DTEXTURE_ID=" + scene.textures.functions[k].id);
            own.push_back(std::string("-DIS_UNIFORM=") + is_uniform);
        }
    sources.push_back({"kernels_cpu/texture_lanes.cpp", "as_cpp", textures.definitions, flags});
    for (Source& source : sources) source.flags.push_back("-c");
    return sources;
}

void compile_lanes(const Compiler& compiler, const std::vector<Source>& sources,
                   const fs::path& root, const fs::path& object)
{
    std::vector<std::string> objects(sources.size());
    for_each_at_once(sources.size(), [&](size_t k) {
        const fs::path made = cache_folder() / "textures" / "objects" /
                              key_of(compiler.program, sources[k]) / "part.o";
        if (!is_whole(made)) compile(compiler, sources[k], root, made);
        objects[k] = made.string();
    });
    std::vector<std::string> command = {compiler.program, "-shared"};
    command.insert(command.end(), sanitizers.begin(), sanitizers.end());
    command.insert(command.end(), objects.begin(), objects.end());
    make(command, compiler.most_seconds, object, object.parent_path() / "functions.hpp");
}

}  // namespace

unsigned long texture_compilations() { return compilations; }
void count_texture_compilation() { ++compilations; }

NativeStage::NativeStage(const SceneData& scene, const NativeStageOptions& options)
{
    const Compiler compiler{compiler_program(), options.most_seconds};
    std::vector<std::string> flags = flags_for(options);
    if (is_in_lanes(options)) add_flags_of_gcc(compiler.program, flags);
    const CppTextures textures =
        cpp_textures(scene, {options.generated_dir, options.use_generated});
    const char* dialect = options.kind == NativeStageKind::reference ? "as_double" : "as_cpp";
    Source whole{"kernels_cpu/texture_stage.cpp", dialect, textures.all, flags};
    whole.flags.push_back("-shared");
    const fs::path object =
        cache_folder() / "textures" / key_of(compiler.program, whole) / "stage.so";
    if (!is_whole(object)) {
        const fs::path root = headers();
        const auto compile_to = [&](const fs::path& made, const CppTextures& texts) {
            whole.functions = texts.all;
            if (is_in_lanes(options))
                compile_lanes(compiler, sources_in_lanes(scene, texts, flags), root, made);
            else
                compile(compiler, whole, root, made);
        };
        try {
            compile_to(object, textures);
        } catch (const RefusedCode&) {
            if (options.use_generated.empty()) throw;
            // once more, for a message that names lines of the edited copy
            compile_to(object.string() + ".copy",
                       cpp_textures(scene, {"", options.use_generated, true}));
            throw;
        }
        count_texture_compilation();
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
