// Checks a glTF document against the parts of the schema that we read.
#pragma once

#include <nlohmann/json.hpp>

namespace diptych {

// Returns the document reduced to the properties that the loader reads: everything in it has the
// type and the range that the schema demands, every index names something that exists, and every
// accessor and buffer view lies within what it refers to, as declared. So the code behind it may
// rely on all that. Throws SceneError ("where: what; what to do").
nlohmann::json checked_gltf(const nlohmann::json& document);

// Bytes of one element of an accessor, from its (checked) properties.
size_t element_size(int component_type, const std::string& type);

}  // namespace diptych
