// Procedural textures of a scene as the devices are given them: what the texture tool made of each
// user function, and what the scene's graph needs at run time. Plain data.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace diptych {

struct TextureArgument {
    std::string name;
    std::string type;  // of a value or an element: float, int2, sam2D ...
    bool is_array = false;
    int length = 0;               // of an array, as declared; 0: as long as the scene makes it
    std::string default_value{};  // JSON, as the file's comment says; empty: none
    std::string about{};          // what the comment says of it
};

// Numbers in an element: 3 of float3.
inline int width_of(const TextureArgument& argument)
{
    const char last = argument.type.back();
    return argument.type != "sam2D" && last >= '0' && last <= '9' ? last - '0' : 1;
}

// "float3[4]"
inline std::string type_of(const TextureArgument& argument)
{
    if (!argument.is_array) return argument.type;
    return argument.type + "[" + (argument.length > 0 ? std::to_string(argument.length) : "") + "]";
}

enum class Hemisphere { upper, lower, both };

struct OcclusionRequest {
    double distance = 0;
    int distance_argument = -1;  // the argument that gives it, if any
    Hemisphere hemisphere = Hemisphere::upper;
    bool is_same_object = false;
};

// One function of a user's file, translated.
struct TextureFunction {
    std::string id;     // in generated code
    std::string file;   // as the user named it
    std::string entry;  // the user's own name of it
    std::string asked;  // the name that the scene gave; empty: it left the choice to the tool
    std::string cpp;    // for namespace user_language
    std::string opencl;
    std::vector<TextureArgument> arguments;
    std::vector<OcclusionRequest> occlusion;
    int channels = 4;         // numbers in its result
    unsigned attributes = 0;  // mask of ATTRIBUTE_*
    std::vector<std::string> warnings;
    std::string description;  // by the tool, in JSON
};

// One use of a node of the graph by a material: its arguments' region.
struct TextureAttachment {
    std::string node;
    int material = 0;  // -1: all, for a layer of the picture
    int function = 0;
    int first_word = 0;  // in the words of the materials
    int words = 0;       // in whole pages
    int node_id = 0;     // in SceneTextures::nodes
};

// A node of the graph as it was asked for: its arguments' values in JSON, from the scene, the
// command line or the file's comments.
struct TextureNodeValues {
    std::string name;
    int function = 0;
    std::map<std::string, std::string> values;
};

// A node that a layer of the picture shows.
struct TextureAov {
    std::string node;  // its name
    int channels = 4;  // that it gives

    bool operator==(const TextureAov&) const = default;
};

struct SceneTextures {
    std::vector<TextureFunction> functions;
    bool is_one_text = false;  // functions' texts need those before them
    std::vector<TextureNodeValues> nodes;
    std::vector<TextureAttachment> attachments;
    unsigned attributes = 0;    // of all functions
    int slots = 1;              // of the interpreter's stack
    int outputs = 0;            // results a path that evaluate_surface reads
    int occlusion_results = 0;  // a path
    int records = 0;            // a path
    int distances = 0;          // of occlusion, that nodes give, a path
    std::vector<TextureAov> aovs;
    int first_page = 0;  // of the materials' buffer that no longer holds a material
};

}  // namespace diptych
