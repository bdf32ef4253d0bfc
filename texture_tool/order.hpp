// What C leaves to compilers: the order in which the parts of one expression are computed.
#pragma once

#include <set>

#include <clang/AST/Decl.h>
#include <clang/AST/Expr.h>

namespace texture_tool {

// Finds a variable that one part of an expression changes and another uses, where nothing says
// which comes first: compilers differ there, and so would pictures.
class Order {
public:
    struct Clash {
        const clang::VarDecl* variable = nullptr;
        const clang::Expr* at = nullptr;
    };

    // Of a whole expression; without a variable: none.
    Clash clash_in(const clang::Expr* whole);

private:
    struct Used {
        std::set<const clang::VarDecl*> read, changed;
    };

    Used used_by(const clang::Expr* node);
    Used used_by_call(const clang::CallExpr* node);
    Used used_by_binary(const clang::BinaryOperator* node);
    Used changed_by(const clang::Expr* target, bool is_read);
    Used side_by_side(const Used& a, const Used& b, const clang::Expr* at);
    void compare(const Used& changes, const Used& uses, const clang::Expr* at);

    Clash clash_;
};

}  // namespace texture_tool
