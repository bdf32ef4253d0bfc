#include "texture_tool/messages.hpp"

#include <utility>

#include "texture_tool/language.hpp"

namespace texture_tool {

namespace {

// The first text between quotes.
std::string quoted(const std::string& message)
{
    const size_t open = message.find('\'');
    const size_t close = message.find('\'', open + 1);
    return close == std::string::npos ? "" : message.substr(open + 1, close - open - 1);
}

std::string unknown_function(const std::string& name)
{
    if (name == "StoreNormal" || name.rfind("Store", 0) == 0)
        return "unknown function '" + name +
               "': a texture cannot write into the renderer; return the "
               "value, and let the scene use it as a normal";
    if (name == "fract" || name == "frac")
        return "unknown function '" + name + "'; write x - floor(x)";
    if (name == "lerp") return "unknown function 'lerp'; OpenCL calls it mix";
    if (name == "saturate") return "unknown function 'saturate'; write clamp(x, 0.0f, 1.0f)";
    if (name == "inversesqrt") return "unknown function 'inversesqrt'; OpenCL calls it rsqrt";
    return "unknown function '" + name +
           "'; textures call their own functions, defined above the call, "
           "and OpenCL's";
}

const std::pair<const char*, const char*> remedies[] = {
    {"no matching function for call", "; check the number and types of the arguments"},
    {"call to", "; give the arguments the same type, as in max(0.0f, x)"},
    {"too few arguments", "; give every argument"},
    {"too many arguments", "; leave out what the function does not take"},
    {"undeclared identifier", "; declare it first"},
    {"unknown type name", "; textures have C's and OpenCL's types, sam2D and their own"},
    {"expected ';'", "; add it"},
    {"expected '}'", "; add it"},
    {"expected ')'", "; add it"},
    {"redefinition", "; give one of them another name"},
    {"conflicting types", "; make the declarations alike"},
    {"not a compile-time constant", "; only constants may stand there"},
    {"incompatible type", "; convert it: convert_float3(v), v.xyz, (float3)(x)"},
    {"cannot convert between vector", "; convert it: convert_float3(v), v.xyz, (float4)(v, 1.0f)"},
    {"implicit conversion", "; convert it: convert_float3(v), v.xyz, (float4)(v, 1.0f)"},
    {"invalid operands", "; make both sides the same type: convert_float3(v), v.xyz, (float3)(x)"},
    {"const-qualified", "; it cannot be changed: copy it to a variable of your own"},
    {"not assignable", "; assign to a variable"},
    {"called object type", "; a variable hides what has its name: rename it, or call a function"},
    {"unsequenced", "; compilers take them in different orders: use a statement for each"},
    {"discards qualifiers", "; it cannot be changed: copy it to a variable of your own"},
    {"incompatible pointer types", "; pass an array of the parameter's own type"},
    {"function pointer", "; GPUs have none: call the function by its name"},
    {"pointers to functions", "; GPUs have none: call the function by its name"},
    {"variable length array", "; give the array a constant length"},
    {"variadic", "; name each argument"},
    {"vector component", "; components are x y z w, or s0 to sf"},
    {"type name requires a specifier", "; write the type: int, float, float3"},
    {"type specifier is required", "; write the type: int, float, float3"},
    {"bracket nesting level", "; split the expression"},
    {"unterminated", "; end it"},
    {"array is too large", "; make it an array argument"},
    {"double precision", "; use float"},
    {"tentative", "; give it a value"},
};

}  // namespace

std::string with_remedy(const std::string& said)
{
    std::string message = said;
    for (const char* word : {"__private ", "__generic ", "__global ", "__constant ", "__private"})
        for (size_t at = 0; (at = message.find(word)) != std::string::npos;)
            message.erase(at, std::string(word).size());
    if (message.find("typedef type") != std::string::npos)
        return "a function that is not available to textures is called; use OpenCL's math, "
               "geometric, "
               "common, relational and integer functions";
    if (message.find("implicit declaration of function") != std::string::npos ||
        (message.find("call to undeclared function") != std::string::npos))
        return unknown_function(quoted(message));
    if (message.find("no matching function for call to 'fract'") != std::string::npos)
        return "OpenCL's fract(x, &whole) takes an address too; write x - floor(x)";
    for (const auto& [part, remedy] : remedies)
        if (message.find(part) != std::string::npos) return message + remedy;
    return message + "; correct it to C99 with OpenCL's vectors";
}

}  // namespace texture_tool
