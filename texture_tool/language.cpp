#include "texture_tool/language.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <sstream>

namespace texture_tool {

namespace {

const std::map<std::string, std::string> synonyms = {
    {"Norm", "Normal"}, {"ShadeNorm", "Normal"}, {"ModelPos", "LocalPos"}, {"Tang", "Tangent"},
    {"Tan", "Tangent"}, {"Bitang", "Bitangent"}, {"Bitan", "Bitangent"},   {"Binorm", "Bitangent"},
};

std::set<std::string> words_of(const char* text)
{
    std::istringstream stream(text);
    std::set<std::string> words;
    for (std::string word; stream >> word;) words.insert(word);
    return words;
}

// What overloads of readX(NAME) select by their argument, as the parser is told.
void declare_reader(std::ostream& out, const std::string& type, const std::string& function,
                    const std::string& name, const std::string& first, const std::string& rest)
{
    out << type << " __attribute__((overloadable)) " << function << "(" << first
        << "__constant const char* name" << rest
        << ") __attribute__((enable_if(__builtin_strcmp(name, \"" << name << "\") == 0, \"\")));\n";
}

int edit_distance(const std::string& a, const std::string& b)
{
    std::vector<int> row(b.size() + 1);
    for (size_t j = 0; j <= b.size(); ++j) row[j] = static_cast<int>(j);
    for (size_t i = 1; i <= a.size(); ++i) {
        int diagonal = row[0];
        row[0] = static_cast<int>(i);
        for (size_t j = 1; j <= b.size(); ++j) {
            const int change = diagonal + (tolower(a[i - 1]) != tolower(b[j - 1]) ? 1 : 0);
            diagonal = row[j];
            row[j] = std::min({change, row[j] + 1, row[j - 1] + 1});
        }
    }
    return row[b.size()];
}

}  // namespace

const std::vector<Attribute>& attributes()
{
    static const std::vector<Attribute> table = {
        {"WorldPos", "float3"},    {"LocalPos", "float3"},    {"Normal", "float3"},
        {"GeomNormal", "float3"},  {"Tangent", "float3"},     {"Bitangent", "float3"},
        {"TexCoord0", "float2"},   {"TexCoord1", "float2"},   {"TexCoord0Dx", "float2"},
        {"TexCoord0Dy", "float2"}, {"VertexColor", "float4"}, {"ViewDir", "float3"},
        {"ObjectId", "int"},       {"InstanceId", "int"},     {"PrimitiveId", "int"},
        {"Time", "float"},
    };
    return table;
}

const std::vector<std::string>& settings()
{
    static const std::vector<std::string> table = {"Time", "Frame", "Width", "Height", "Samples"};
    return table;
}

std::string attribute_of(const std::string& name)
{
    for (const Attribute& attribute : attributes())
        if (name == attribute.name) return name;
    const auto synonym = synonyms.find(name);
    return synonym == synonyms.end() ? "" : synonym->second;
}

std::vector<std::string> attribute_names()
{
    std::vector<std::string> names;
    for (const Attribute& attribute : attributes()) names.push_back(attribute.name);
    return names;
}

std::string nearest(const std::string& name, const std::vector<std::string>& known)
{
    std::string best;
    int best_distance = std::max(2, static_cast<int>(name.size()) / 2);
    for (const std::string& candidate : known) {
        const int distance = edit_distance(name, candidate);
        if (distance <= best_distance && (best.empty() || distance < best_distance)) {
            best = candidate;
            best_distance = distance;
        }
    }
    return best;
}

std::string attribute_problem(const std::string& name)
{
    if (name == "AO" || name == "AO0" || name == "AO1" || !attribute_of(name).empty()) return "";
    const std::string near = nearest(name, attribute_names());
    std::string known;
    for (const std::string& one : attribute_names()) known += (known.empty() ? "" : ", ") + one;
    return "unknown attribute \"" + name + "\"; " +
           (near.empty() ? "" : "did you mean \"" + near + "\"? ") + "Known: " + known;
}

std::string setting_problem(const std::string& name)
{
    const std::vector<std::string>& known = settings();
    if (std::find(known.begin(), known.end(), name) != known.end()) return "";
    const std::string near = nearest(name, known);
    return "unknown setting \"" + name + "\"; nearest: \"" + (near.empty() ? known[0] : near) +
           "\"; known: Time, Frame, Width, Height, Samples";
}

bool is_library_function(const std::string& name)
{
    static const std::set<std::string> names = words_of(
        "acos acosh acospi asin asinh asinpi atan atan2 atan2pi atanh atanpi cbrt ceil copysign "
        "cos cosh cospi erf erfc exp exp10 exp2 expm1 fabs fdim floor fma fmax fmin fmod fract "
        "frexp hypot ilogb ldexp lgamma log log10 log1p log2 logb mad maxmag minmag modf nan "
        "nextafter pow pown powr remainder rint rootn round rsqrt sin sincos sinh sinpi sqrt tan "
        "tanh tanpi tgamma trunc clamp degrees max min mix radians sign smoothstep step cross dot "
        "distance length normalize isequal isnotequal isgreater isgreaterequal isless "
        "islessequal islessgreater isfinite isinf isnan isnormal isordered isunordered signbit "
        "any all bitselect select abs abs_diff add_sat clz hadd rhadd mad24 mad_hi mad_sat mul24 "
        "mul_hi popcount rotate sub_sat recip divide");
    if (names.count(plain_library_name(name))) return true;
    // convert_int3, convert_int3_sat, as_uint4: the 32-bit types.
    for (const char* prefix : {"convert_", "as_"}) {
        if (name.rfind(prefix, 0) != 0) continue;
        const std::string rest = name.substr(std::string(prefix).size());
        for (const char* type : {"float", "int", "uint"}) {
            if (rest.rfind(type, 0) != 0) continue;
            const std::string tail = rest.substr(std::string(type).size());
            static const std::set<std::string> tails =
                words_of("2 3 4 8 16 _sat 2_sat 3_sat 4_sat 8_sat 16_sat _rtz 2_rtz 3_rtz 4_rtz");
            if (tail.empty() || tails.count(tail)) return true;
        }
    }
    return false;
}

std::string plain_library_name(const std::string& name)
{
    for (const char* prefix : {"native_", "half_", "fast_"}) {
        const size_t size = std::string(prefix).size();
        if (name.rfind(prefix, 0) == 0) return name.substr(size);
    }
    return name;
}

bool is_engine_function(const std::string& name)
{
    static const std::set<std::string> names = words_of(
        "make_float2 make_float3 make_float4 make_float3x3 to_float3 to_float4 mul3x3x3 tex2D "
        "texture2D readAttr readSetting readOcclusion");
    return names.count(name) > 0;
}

bool is_engine_type(const std::string& name)
{
    static const std::set<std::string> names = words_of("sam2D sampler2D float3x3 SurfaceInfo");
    return names.count(name) > 0;
}

bool is_opencl_word(const std::string& name)
{
    static const std::set<std::string> names = words_of(
        "kernel global local constant private generic read_only write_only read_write half "
        "image1d_t image2d_t image3d_t image1d_array_t image2d_array_t image1d_buffer_t sampler_t "
        "event_t clk_event_t queue_t ndrange_t reserve_id_t pipe uniform quad complex imaginary "
        "__kernel __local __read_only __write_only __generic");
    return names.count(name) > 0;
}

bool needs_other_name(const std::string& name)
{
    static const std::set<std::string> names = words_of(
        // C++'s keywords that C leaves free
        "alignas alignof and and_eq asm auto bitand bitor bool catch char8_t char16_t char32_t "
        "class co_await co_return co_yield compl concept const_cast consteval constexpr constinit "
        "decltype delete dynamic_cast explicit export false friend import module mutable namespace "
        "new noexcept not not_eq nullptr operator or or_eq private protected public "
        "reinterpret_cast requires static_assert static_cast template this thread_local throw true "
        "try typeid typename using virtual wchar_t xor xor_eq "
        // macros of the house's headers, of compilers and of the C library
        "GLOBAL CONSTANT SHARED STORED PLANE PI INV_PI FLOAT_MAX FLOAT_EPSILON FLOAT_INFINITY "
        "FLOAT_NAN ALWAYS_INLINE EFFECTS uses LAYOUT_CHECK linux unix i386 NULL NAN INFINITY EOF "
        "MAXFLOAT HUGE_VAL HUGE_VALF RAND_MAX DOMAIN SING OVERFLOW UNDERFLOW errno major minor "
        "assert offsetof va_list size_t std diptych user_language Vector Scalar Truth "
        "TextureContext Scene Paths float_to_int choose width_of component_of stored");
    if (names.count(name)) return true;
    for (const char* prefix : {"tx_", "TX_", "math_", "vec_", "M_", "FLT_", "INT_", "UINT_", "CL_",
                               "CHAR_", "LONG_", "FP_", "EFFECT_", "PLANE_", "SCENE_", "PATH_"})
        if (name.rfind(prefix, 0) == 0) return true;
    return name[0] == '_';
}

std::string prelude()
{
    std::ostringstream out;
    out << "typedef unsigned char uchar; typedef unsigned short ushort;\n"
           "typedef unsigned int uint; typedef unsigned long ulong;\n"
           "typedef __SIZE_TYPE__ size_t; typedef __PTRDIFF_TYPE__ ptrdiff_t;\n";
    for (const char* type :
         {"char", "uchar", "short", "ushort", "int", "uint", "long", "ulong", "float"})
        for (int n : {2, 3, 4, 8, 16})
            out << "typedef " << type << " " << type << n << " __attribute__((ext_vector_type(" << n
                << ")));\n";
    out << "#define __opencl_c_generic_address_space 1\n"
           "#define NULL ((void*)0)\n"
           "typedef uint cl_mem_fence_flags;\n"
           "#define __global\n"
           "#define INFINITY (1e39f)\n#define NAN (1e39f * 0.0f)\n"
           "#define HUGE_VALF (1e39f)\n"
           "#define MAXFLOAT 3.402823466e+38f\n#define FLT_MAX 3.402823466e+38f\n"
           "#define FLT_MIN 1.175494351e-38f\n#define FLT_EPSILON 1.1920928955078125e-7f\n"
           "#define INT_MAX 2147483647\n#define INT_MIN (-2147483647-1)\n"
           "#define UINT_MAX 4294967295u\n#define CHAR_BIT 8\n";
    const std::pair<const char*, const char*> constants[] = {
        {"E", "2.71828183f"},        {"LOG2E", "1.44269504f"},    {"LOG10E", "0.434294482f"},
        {"LN2", "0.693147181f"},     {"LN10", "2.30258509f"},     {"PI", "3.14159265f"},
        {"PI_2", "1.57079633f"},     {"PI_4", "0.785398163f"},    {"1_PI", "0.318309886f"},
        {"2_PI", "0.636619772f"},    {"2_SQRTPI", "1.12837917f"}, {"SQRT2", "1.41421356f"},
        {"SQRT1_2", "0.707106781f"},
    };
    for (const auto& [name, value] : constants)
        out << "#define M_" << name << " " << value << "\n#define M_" << name << "_F " << value
            << "\n";
    out << "#define TEX_POINT_SAM 0x10000000u\n#define TEX_ALPHASRC_W 0x20000000u\n"
           "#define TEX_CLAMP_U 0x40000000u\n#define TEX_CLAMP_V 0x80000000u\n"
           "typedef struct SurfaceInfo SurfaceInfo;\n"
           "typedef struct sam2D_ { int slot_; } sam2D; typedef sam2D sampler2D;\n"
           "typedef struct { float3 row[3]; } float3x3;\n"
           "float2 make_float2(float x, float y); float3 make_float3(float x, float y, float z);\n"
           "float4 make_float4(float x, float y, float z, float w);\n"
           "float3x3 make_float3x3(float3 a, float3 b, float3 c);\n"
           "float3 to_float3(float4 v); float4 to_float4(float3 v, float w);\n"
           "float3 mul3x3x3(float3x3 m, float3 v);\n"
           "float4 tex2D(sam2D image, float2 uv);\n"
           "float4 __attribute__((overloadable)) texture2D(sam2D image, float2 uv);\n"
           "float4 __attribute__((overloadable)) texture2D(sam2D image, float2 uv, uint flags);\n";
    const std::string engine = "const SurfaceInfo* hit, ";
    for (const std::string& first : {std::string(), engine}) {
        for (const Attribute& attribute : attributes())
            declare_reader(out, attribute.type, "readAttr", attribute.name, first, "");
        for (const auto& [name, attribute] : synonyms)
            for (const Attribute& known : attributes())
                if (attribute == known.name)
                    declare_reader(out, known.type, "readAttr", name, first, "");
        // Any other name: the walk says what is wrong with it.
        out << "float __attribute__((overloadable)) readAttr(" << first
            << "__constant const char* name);\n"
            << "float __attribute__((overloadable)) readAttr(" << first << "const char* name);\n";
    }
    out << "float __attribute__((overloadable)) readSetting(__constant const char* name);\n"
           "float __attribute__((overloadable)) readSetting(const char* name);\n"
           "float __attribute__((overloadable)) readOcclusion(__constant const char* where, float "
           "distance);\n";
    for (const char* to : {"float", "int", "uint"})
        for (const char* from : {"float", "int", "uint"})
            for (const char* n : {"", "2", "3", "4", "8", "16"})
                out << to << n << " __attribute__((overloadable)) as_" << to << n << "(" << from
                    << n << " x);\n";
    return out.str();
}

}  // namespace texture_tool
