// From Clang's tree to plain data. Only find.cpp and the walk's own files know Clang's types.
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include <clang/AST/ASTContext.h>
#include <clang/AST/Decl.h>
#include <clang/AST/Expr.h>
#include <clang/AST/Stmt.h>

#include "texture_tool/description.hpp"
#include "texture_tool/interval.hpp"

namespace texture_tool {

class Walk {
public:
    // `numbers`: the token at each location; `own_names`: what rename_own gave the parser.
    Walk(clang::ASTContext& context, const std::map<unsigned, int>& numbers,
         const std::map<std::string, std::string>& own_names, Description& description);

    void run();

private:
    // Declarations.
    void file_variable(const clang::VarDecl* variable);
    void declare_function(const clang::FunctionDecl* function);
    Parameter parameter_of(const clang::ParmVarDecl* parameter);
    void record(const clang::RecordDecl* type);
    void types_in(const clang::TypeSourceInfo* written);
    void type_allowed(clang::QualType type, clang::SourceLocation at, const std::string& what);
    void local_variable(const clang::VarDecl* variable, const clang::DeclStmt* statement);
    void initialiser(const clang::Expr* value, bool is_constant);
    void watch(const clang::Expr* value);

    // Statements and expressions; children before parents.
    void statement(const clang::Stmt* node);
    void children(const clang::Stmt* node);
    void loop(const clang::Stmt* node);
    void redeclared(const clang::ForStmt* loop);
    void switch_statement(const clang::SwitchStmt* node);
    void whole_expression(const clang::Expr* node);
    void expression(const clang::Expr* node);
    void reference(const clang::DeclRefExpr* node);
    void binary(const clang::BinaryOperator* node);
    void assignment(const clang::BinaryOperator* node);
    void unary(const clang::UnaryOperator* node);
    void call(const clang::CallExpr* node);
    void user_call(const clang::CallExpr* node, int callee);
    void user_argument(const clang::Expr* argument, const Parameter& parameter);
    void library_call(const clang::CallExpr* node, const std::string& name);
    void reader_call(const clang::CallExpr* node, const std::string& name);
    void occlusion_call(const clang::CallExpr* node);
    void implicit_cast(const clang::ImplicitCastExpr* node);
    void explicit_cast(const clang::CStyleCastExpr* node);
    void conversion(const clang::Expr* node, const clang::Expr* operand, int open);
    std::string arithmetic_function(clang::BinaryOperatorKind kind, clang::QualType type,
                                    const clang::Expr* left, const clang::Expr* right,
                                    clang::QualType count, bool& only_opencl) const;
    void subscript(const clang::ArraySubscriptExpr* node);
    void swizzle(const clang::ExtVectorElementExpr* node);
    void fill_swizzle(const clang::ExtVectorElementExpr* node, Site& site) const;
    void swizzle_write(const clang::ExtVectorElementExpr* node, const clang::BinaryOperator* write);
    void member(const clang::MemberExpr* node);
    void choice(const clang::ConditionalOperator* node);
    void initialiser_list(const clang::InitListExpr* node);

    // Helpers.
    int token_at(clang::SourceLocation at) const;
    Range range_of(const clang::Stmt* node) const;
    Range range_of(clang::SourceRange range) const;
    int find_token(int from, int to, const std::string& text) const;
    int matching_close(int open) const;
    void complain(clang::SourceLocation at, const std::string& text, bool is_error = true);
    std::string own_name(const std::string& name) const;
    std::string spelled_type(clang::QualType type) const;  // float3, "" for what is not a number
    void rename(int token, const std::string& name, bool is_global);
    bool is_users(const clang::Decl* declaration) const;
    bool is_constant(const clang::Expr* node) const;
    Interval interval_of(const clang::Expr* node) const;
    bool has_side_effects(const clang::Expr* node) const;
    bool holds_image(clang::QualType type) const;
    const Parameter* parameter_named(const clang::Expr* node) const;
    Site& add(SiteKind kind);

    clang::ASTContext& context_;
    const std::map<unsigned, int>& numbers_;
    std::map<std::string, std::string> real_names_;
    Description& description_;
    std::map<const clang::FunctionDecl*, int> function_numbers_;
    std::map<const clang::ParmVarDecl*, std::pair<int, int>> parameter_numbers_;
    std::map<const clang::VarDecl*, Interval> counters_;  // of loops with known bounds
    std::set<const clang::Stmt*> statement_expressions_;  // whose value nobody uses
    std::set<const clang::Stmt*> bounded_steps_;  // counters' changes, which cannot overflow
    std::set<const clang::Expr*> handled_;  // by their parents: written swizzles, passed arrays
    // What it is told of lies one level deeper, for as long as it lives.
    class Level {
    public:
        explicit Level(int& depth) : depth_(depth) { ++depth_; }
        ~Level() { --depth_; }
        Level(const Level&) = delete;
        Level& operator=(const Level&) = delete;

    private:
        int& depth_;
    };
    bool is_too_deep(const clang::Stmt* node);

    int depth_ = 0;                                // of the statement or expression
    const clang::VarDecl* initialised_ = nullptr;  // the local variable whose value is walked
    int function_ = -1;
    long trips_ = 1;
    bool in_constant_ = false;
};

}  // namespace texture_tool
