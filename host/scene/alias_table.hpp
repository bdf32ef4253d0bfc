// Choosing one of many by weight in constant time.
#pragma once

#include "platform.h"

#include "common/layout.h"

#include <span>
#include <vector>

namespace diptych {

// Vose's table for weights that are finite and not negative; the same for the same weights on every
// machine. Empty if they sum to zero.
std::vector<AliasEntry> alias_table(std::span<const double> weights);

}  // namespace diptych
