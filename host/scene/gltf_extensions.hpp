// What we do with each extension of glTF that we know.
#pragma once

#include <string>
#include <vector>

namespace diptych {

enum class ExtensionSupport {
    unknown,
    simulated,
    ignored,       // changes nothing that a still picture shows
    not_simulated  // the material is rendered without it
};

ExtensionSupport extension_support(const std::string& name);

// Throws SceneError naming the first required extension that is unknown. Returns notices about
// those that are used but not simulated.
std::vector<std::string> check_extensions(const std::vector<std::string>& used,
                                          const std::vector<std::string>& required);

}  // namespace diptych
