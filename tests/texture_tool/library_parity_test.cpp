// The library's textures as the texture tool writes them: the same bits as scalar C++, as
// vectorised C++ and on every OpenCL device, with the arguments that their headers name.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <memory>
#include <regex>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/common/opencl_handles.hpp"
#include "tests/texture_tool/library_loops.hpp"

namespace {

using nlohmann::json;
using Words = std::vector<std::uint32_t>;
using Floats = std::vector<float>;

constexpr int hit_floats = 13;
constexpr int hit_count = 4096;

std::string text_of(const std::string& path)
{
    std::ifstream file(path);
    EXPECT_TRUE(file) << path;
    return {std::istreambuf_iterator<char>(file), {}};
}

json description_of(const std::string& name)
{
    return json::parse(text_of(std::string(LIBRARY_GENERATED) + "/" + name + ".json"));
}

struct HeaderArgument {
    std::string name, type;
    json value;
};

// Lines `// name (type, unit and range; default JSON): meaning`.
std::vector<HeaderArgument> header_of(const std::string& name)
{
    const std::string text = text_of(std::string(LIBRARY_SOURCES) + "/" + name + ".c");
    static const std::regex line(
        R"(// (\w+) \((\w+(?:\[\])?)[^;\n]*; default ([^\n]*?)\)(?:: |\n))");
    std::vector<HeaderArgument> list;
    for (std::sregex_iterator i(text.begin(), text.end(), line), end; i != end; ++i) {
        const std::string value = (*i)[3].str();
        list.push_back({(*i)[1], (*i)[2], value == "white" ? json(-1) : json::parse(value)});
    }
    return list;
}

std::uint32_t word_of(const json& value, const std::string& type)
{
    if (type.rfind("float", 0) != 0) return std::uint32_t(value.get<int>());
    const float number = value.get<float>();
    std::uint32_t word;
    std::memcpy(&word, &number, 4);
    return word;
}

void append(Words& words, const json& value, const std::string& type)
{
    const json list = value.is_array() ? value : json::array({value});
    for (const json& number : list) words.push_back(word_of(number, type));
}

// An argument region at word 0 that holds the defaults.
Words region_of(const std::string& name)
{
    const std::vector<HeaderArgument> header = header_of(name);
    Words words(4 * header.size(), 0u);
    for (size_t k = 0; k < header.size(); ++k) {
        const bool is_array = header[k].type.find('[') != std::string::npos;
        words[4 * k] = 0xffffffffu;
        words[4 * k + 1] = std::uint32_t(words.size());
        words[4 * k + 2] = std::uint32_t(is_array ? header[k].value.size() : 1);
        if (!is_array) {
            append(words, header[k].value, header[k].type);
        } else {
            for (const json& element : header[k].value) {
                append(words, element, header[k].type);
                if (element.size() == 3) words.push_back(0u);
            }
        }
        while (words.size() % 4 != 0) words.push_back(0u);
    }
    return words;
}

Floats make_hits()
{
    Floats hits(hit_floats * hit_count);
    std::uint32_t state = 12345;
    const auto next = [&] {
        state = state * 1664525u + 1013904223u;
        return float(state >> 8) * 5.9604645e-8f;
    };
    for (int k = 0; k < hit_count; ++k) {
        float hit[hit_floats];
        for (int c = 0; c < 3; ++c) hit[c] = (next() - 0.5f) * (k % 4 == 0 ? 100.0f : 2.0f);
        const float z = 2.0f * next() - 1.0f;
        const float turn = 6.2831853f * next();
        hit[3] = std::sqrt(1.0f - z * z) * std::cos(turn);
        hit[4] = std::sqrt(1.0f - z * z) * std::sin(turn);
        hit[5] = z;
        for (int c = 6; c < 8; ++c) hit[c] = 4.0f * next() - 2.0f;
        for (int c = 8; c < 12; ++c) hit[c] = k % 2 == 0 ? 0.0f : 0.02f * next() - 0.01f;
        hit[12] = next();
        for (int c = 0; c < hit_floats; ++c) hits[c * hit_count + k] = hit[c];
    }
    return hits;
}

struct Results {
    Floats values = Floats(4 * hit_count);
    std::vector<int> clamped = std::vector<int>(hit_count);
};

Results run(LibraryLoop loop, const Floats& hits, const Words& words)
{
    Results results;
    loop(hits.data(), words.data(), hit_count, results.values.data(), results.clamped.data());
    return results;
}

int different(const Floats& a, const Floats& b)
{
    int count = 0;
    for (size_t k = 0; k < a.size(); ++k) count += std::memcmp(&a[k], &b[k], 4) != 0 ? 1 : 0;
    return count;
}

class LibraryTexture : public testing::TestWithParam<std::string> {};

TEST_P(LibraryTexture, DescribesItsArgumentsInItsHeader)
{
    const json arguments = description_of(GetParam())["arguments"];
    const std::vector<HeaderArgument> header = header_of(GetParam());
    ASSERT_EQ(header.size(), arguments.size());
    for (size_t k = 0; k < header.size(); ++k) {
        EXPECT_EQ(header[k].name, arguments[k]["name"]);
        const std::string brackets = arguments[k]["is_array"].get<bool>() ? "[]" : "";
        EXPECT_EQ(header[k].type, arguments[k]["type"].get<std::string>() + brackets);
    }
    EXPECT_TRUE(description_of(GetParam())["warnings"].empty());
}

TEST_P(LibraryTexture, IsInTheManual)
{
    const std::string manual = text_of(LIBRARY_MANUAL);
    const size_t start = manual.find("## " + GetParam() + "\n");
    ASSERT_NE(start, std::string::npos);
    const std::string section = manual.substr(start, manual.find("\n## ", start) - start);
    for (const HeaderArgument& argument : header_of(GetParam()))
        EXPECT_NE(section.find("| `" + argument.name + "` | " + argument.type), std::string::npos)
            << argument.name;
}

TEST_P(LibraryTexture, GivesColorsThatReflectLessThanTheyReceive)
{
    const Results results = run(loops_scalar().at(GetParam()), make_hits(), region_of(GetParam()));
    float low = 1.0f;
    float high = 0.0f;
    for (int k = 0; k < hit_count; ++k) {
        ASSERT_EQ(results.clamped[k], 0);
        for (int c = 0; c < 4; ++c) {
            ASSERT_TRUE(std::isfinite(results.values[c * hit_count + k]));
            ASSERT_GE(results.values[c * hit_count + k], 0.0f);
            ASSERT_LE(results.values[c * hit_count + k], 1.0f);
        }
        low = std::min(low, results.values[hit_count + k]);
        high = std::max(high, results.values[hit_count + k]);
    }
    const std::string name = GetParam();
    const bool is_even = name == "blend" || name.rfind("ramp", 0) == 0;  // of a constant
    if (!is_even) {
        EXPECT_GT(high - low, 0.15f);
    }
}

TEST_P(LibraryTexture, HasTheSameBitsInVectorLanes)
{
    const Floats hits = make_hits();
    const Words words = region_of(GetParam());
    EXPECT_EQ(different(run(loops_scalar().at(GetParam()), hits, words).values,
                        run(loops_vector().at(GetParam()), hits, words).values),
              0);
}

INSTANTIATE_TEST_SUITE_P(All, LibraryTexture, testing::ValuesIn([] {
                             std::vector<std::string> names;
                             for (const auto& [name, loop] : loops_scalar()) names.push_back(name);
                             return names;
                         }()),
                         [](const auto& info) { return info.param; });

class Device {
public:
    explicit Device(cl_device_id device)
    {
        context_.reset(clCreateContext(nullptr, 1, &device, nullptr, nullptr, nullptr));
        queue_.reset(clCreateCommandQueue(context_.get(), device, 0, nullptr));
        const std::string source = text_of(LIBRARY_KERNELS);
        const char* text = source.c_str();
        program_.reset(clCreateProgramWithSource(context_.get(), 1, &text, nullptr, nullptr));
        const char* options = "-cl-std=CL1.2 -cl-fp32-correctly-rounded-divide-sqrt -D EFFECTS=0 "
                              "-D PAGE_SHIFT=0";
        if (clBuildProgram(program_.get(), 1, &device, options, nullptr, nullptr) != CL_SUCCESS) {
            std::vector<char> log(1 << 16);
            clGetProgramBuildInfo(program_.get(), device, CL_PROGRAM_BUILD_LOG, log.size() - 1,
                                  log.data(), nullptr);
            ADD_FAILURE() << log.data();
        }
    }

    Floats run(const std::string& name, const Floats& hits, const Words& words)
    {
        const Kernel kernel(clCreateKernel(program_.get(), (name + "_kernel").c_str(), nullptr));
        EXPECT_TRUE(kernel) << name;
        const Buffer places = filled(hits.data(), hits.size() * 4);
        const Buffer region = filled(words.data(), words.size() * 4);
        Floats values(4 * hit_count);
        const Buffer results = filled(values.data(), values.size() * 4);
        const Buffer clamped = filled(values.data(), hit_count * 4);
        cl_uint index = 0;
        for (const Buffer* buffer : {&places, &region, &results, &clamped}) {
            cl_mem memory = buffer->get();
            clSetKernelArg(kernel.get(), index++, sizeof memory, &memory);
        }
        const size_t count = hit_count;
        EXPECT_EQ(clEnqueueNDRangeKernel(queue_.get(), kernel.get(), 1, nullptr, &count, nullptr, 0,
                                         nullptr, nullptr),
                  CL_SUCCESS);
        clEnqueueReadBuffer(queue_.get(), results.get(), CL_TRUE, 0, values.size() * 4,
                            values.data(), 0, nullptr, nullptr);
        return values;
    }

private:
    Buffer filled(const void* bytes, size_t size)
    {
        return Buffer(clCreateBuffer(context_.get(), CL_MEM_READ_WRITE | CL_MEM_COPY_HOST_PTR, size,
                                     const_cast<void*>(bytes), nullptr));
    }

    Context context_;
    Queue queue_;
    Program program_;
};

TEST(LibraryKernels, HaveTheSameBitsOnEveryDevice)
{
    const Floats hits = make_hits();
    int devices = 0;
    for (cl_device_id id : all_devices()) {
        if (!has_exact_arithmetic(id)) continue;
        ++devices;
        Device device(id);
        for (const auto& [name, loop] : loops_scalar()) {
            const Words words = region_of(name);
            EXPECT_EQ(different(run(loop, hits, words).values, device.run(name, hits, words)), 0)
                << name;
        }
    }
    if (devices == 0) GTEST_SKIP() << "no OpenCL device with IEEE's arithmetic";
}

}  // namespace
