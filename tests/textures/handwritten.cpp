#include "tests/textures/handwritten.hpp"

namespace textures {

using namespace diptych;

TextureFunction handwritten(const std::string& id, std::vector<TextureArgument> arguments,
                            const std::string& body, unsigned attributes)
{
    const std::string own = "userProc";
    const auto text = [&](const std::string& name) {
        std::string parameters = "TextureContext* tx", values = "tx";
        int k = 0;
        for (const TextureArgument& argument : arguments) {
            parameters += ", " + argument.type + " " + argument.name;
            values +=
                ", tx_argument_" + argument.type + "(tx, region, " + std::to_string(k++) + ")";
        }
        return "SHARED float4 " + name + "(" + parameters + ")\n{\n" + body + "\n}\n" +
               "SHARED float4 " + id + "_entry(TextureContext* tx, int region)\n{\n    return " +
               name + "(" + values + ");\n}\n";
    };
    TextureFunction function;
    function.id = id;
    function.file = id + ".c";
    function.entry = own;
    function.cpp = "namespace " + id + " {\n" + text(own) + "}\n";
    function.opencl = text(id + "_" + own);
    function.arguments = std::move(arguments);
    function.attributes = attributes;
    return function;
}

}  // namespace textures
