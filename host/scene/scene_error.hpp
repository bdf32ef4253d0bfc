// The one exception of the scene side. Its text is a line: "where: what; what to do".
#pragma once

#include <stdexcept>

namespace diptych {

struct SceneError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

}  // namespace diptych
