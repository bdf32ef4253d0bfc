// The restricted language as tables: what textures may call, ask for and name.
#pragma once

#include <string>
#include <vector>

namespace texture_tool {

struct Attribute {
    const char* name;
    const char* type;
};

const std::vector<Attribute>& attributes();
const std::vector<std::string>& settings();
// The attribute that a name means, by itself or as a synonym of the predecessor's; "" if none.
std::string attribute_of(const std::string& name);
// The known name nearest to one misspelt, or "".
std::string nearest(const std::string& name, const std::vector<std::string>& known);
std::vector<std::string> attribute_names();
// What is wrong with the name of an attribute or a setting, in words, or "".
std::string attribute_problem(const std::string& name);
std::string setting_problem(const std::string& name);

// Whether OpenCL's built-in function is part of the language, and its name without native_, half_.
bool is_library_function(const std::string& name);
std::string plain_library_name(const std::string& name);
// Functions of the engine, which are not OpenCL's: make_float3, tex2D ...
bool is_engine_function(const std::string& name);
bool is_engine_type(const std::string& name);

// Names that OpenCL C keeps for itself; C++'s keywords; names that the house's headers define.
bool is_opencl_word(const std::string& name);
bool needs_other_name(const std::string& name);

// What the parser reads before the user's file.
std::string prelude();

}  // namespace texture_tool
