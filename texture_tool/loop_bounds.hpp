// How often a for loop runs, where its bounds are constants.
#pragma once

#include <optional>

#include <clang/AST/ASTContext.h>
#include <clang/AST/Decl.h>
#include <clang/AST/Stmt.h>

#include "texture_tool/interval.hpp"

namespace texture_tool {

struct LoopBounds {
    std::optional<long> trips;
    const clang::VarDecl* counter = nullptr;
    Interval values;  // of an integer counter inside the body
};

// A counter that starts at a constant, is compared with one, and changes by one only in the third
// part of the loop; of integers or floats, counted by running it. More than 2^20: unknown.
LoopBounds loop_bounds(clang::ASTContext& context, const clang::ForStmt* loop);

}  // namespace texture_tool
