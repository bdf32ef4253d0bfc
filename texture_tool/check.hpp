// What the language refuses beyond single statements: recursion, work without end, entries that a
// scene could not call.
#pragma once

#include <string>

#include "texture_tool/description.hpp"

namespace texture_tool {

// Finds the entry (`wanted`, or the only function that no other calls) and adds what is wrong to
// the problems; decides which loops need a budget.
void check(Description& description, const std::string& wanted);

bool has_errors(const Description& description);

}  // namespace texture_tool
