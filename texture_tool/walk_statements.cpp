// The walk over statements.
#include "texture_tool/walk.hpp"

#include <clang/Basic/SourceManager.h>

#include "texture_tool/loop_bounds.hpp"
#include "texture_tool/order.hpp"

namespace texture_tool {

using namespace clang;

void Walk::children(const Stmt* node)
{
    for (const Stmt* child : node->children())
        if (child) statement(child);
}

// Compilers take minutes over what is nested deeper, and then end for want of a stack.
bool Walk::is_too_deep(const Stmt* node)
{
    constexpr int deepest = 1000;
    if (depth_ == deepest + 1)
        complain(node->getBeginLoc(), "this is nested more than " + std::to_string(deepest) +
                                          " levels deep; split it into functions, or use a table");
    return depth_ > deepest;
}

void Walk::whole_expression(const Expr* node)
{
    expression(node);
    if (const Order::Clash clash = Order().clash_in(node); clash.variable)
        complain(clash.at->getExprLoc(), "'" + own_name(clash.variable->getName().str()) +
                                             "' is changed and used here in an order that "
                                             "compilers choose; use a statement for each");
}

void Walk::statement(const Stmt* node)
{
    if (const auto* value = dyn_cast<Expr>(node)) return whole_expression(value);
    const Level level(depth_);
    if (is_too_deep(node)) return;
    for (const Stmt* child : node->children())
        if (const auto* value = dyn_cast_or_null<Expr>(child))
            if (isa<CompoundStmt, LabelStmt, CaseStmt, DefaultStmt>(node) ||
                (isa<IfStmt, WhileStmt, DoStmt, ForStmt>(node) && child != *node->child_begin()))
                statement_expressions_.insert(value);
    switch (node->getStmtClass()) {
    case Stmt::DeclStmtClass:
        for (const Decl* declaration : cast<DeclStmt>(node)->decls()) {
            if (const auto* variable = dyn_cast<VarDecl>(declaration))
                local_variable(variable, cast<DeclStmt>(node));
            else if (const auto* type = dyn_cast<RecordDecl>(declaration))
                record(type);
            else if (const auto* name = dyn_cast<TypedefDecl>(declaration))
                types_in(name->getTypeSourceInfo());
            else if (isa<FunctionDecl>(declaration))
                complain(declaration->getLocation(),
                         "a function is declared inside another; move it to the file's level");
        }
        return;
    case Stmt::ForStmtClass:
    case Stmt::WhileStmtClass:
    case Stmt::DoStmtClass:
        return loop(node);
    case Stmt::SwitchStmtClass:
        switch_statement(cast<SwitchStmt>(node));
        return children(node);
    case Stmt::CaseStmtClass:
    case Stmt::DefaultStmtClass:
    case Stmt::CompoundStmtClass:
    case Stmt::IfStmtClass:
        return children(node);
    case Stmt::ReturnStmtClass:
        children(node);
        if (!cast<ReturnStmt>(node)->getRetValue() &&
            !description_.functions[function_].returns_void) {
            Site& site = add(SiteKind::EmptyReturn);
            site.token = token_at(node->getBeginLoc());
            site.number = function_;
        }
        if (const Expr* value = cast<ReturnStmt>(node)->getRetValue()) watch(value);
        return;
    case Stmt::BreakStmtClass:
    case Stmt::ContinueStmtClass:
    case Stmt::NullStmtClass:
        return;
    case Stmt::GotoStmtClass:
    case Stmt::LabelStmtClass:
    case Stmt::IndirectGotoStmtClass:
        complain(node->getBeginLoc(),
                 "goto is not part of the language; use a loop, break, continue or return");
        return;
    default:
        complain(node->getBeginLoc(), "this statement is not part of the language; use C99's "
                                      "if, switch, for, while, do and return");
    }
}

// C++ refuses to jump over a declaration, and a case inside another statement is no loop.
void Walk::switch_statement(const SwitchStmt* node)
{
    const auto* body = dyn_cast<CompoundStmt>(node->getBody());
    std::set<const Stmt*> own;
    const DeclStmt* declared = nullptr;
    if (body)
        for (const Stmt* inner : body->body()) {
            while (const auto* label = dyn_cast<SwitchCase>(inner)) {
                if (declared)
                    complain(declared->getBeginLoc(),
                             "a case jumps over this declaration; put the statements of each case "
                             "in braces");
                declared = nullptr;
                own.insert(label);
                inner = label->getSubStmt();
            }
            if (const auto* declaration = dyn_cast<DeclStmt>(inner)) declared = declaration;
        }
    for (const SwitchCase* label = node->getSwitchCaseList(); label;
         label = label->getNextSwitchCase()) {
        if (!own.count(label))
            complain(label->getBeginLoc(),
                     "this case jumps into a block; put it directly inside the "
                     "switch");
        if (const auto* plain = dyn_cast<CaseStmt>(label))
            if (plain->caseStmtIsGNURange())
                complain(label->getBeginLoc(), "a range of cases is not C99; write each case");
    }
}

namespace {

// Whether a statement can leave the loop around it.
bool leaves(const Stmt* node, bool by_break)
{
    if (isa<ReturnStmt>(node) || (by_break && isa<BreakStmt>(node))) return true;
    const bool keeps = by_break && !isa<ForStmt, WhileStmt, DoStmt, SwitchStmt>(node);
    for (const Stmt* child : node->children())
        if (child && leaves(child, keeps)) return true;
    return false;
}

}  // namespace

// C has a scope between a loop's head and its body, C++ has none.
void Walk::redeclared(const ForStmt* loop)
{
    const auto* head = dyn_cast_or_null<DeclStmt>(loop->getInit());
    const auto* body = dyn_cast<CompoundStmt>(loop->getBody());
    if (!head || !body) return;
    std::set<llvm::StringRef> names;
    for (const Decl* declared : head->decls())
        if (const auto* variable = dyn_cast<VarDecl>(declared)) names.insert(variable->getName());
    for (const Stmt* inner : body->body()) {
        const auto* statement = dyn_cast<DeclStmt>(inner);
        if (!statement) continue;
        for (const Decl* declared : statement->decls())
            if (const auto* named = dyn_cast<NamedDecl>(declared))
                if (names.count(named->getName()))
                    complain(named->getLocation(),
                             "'" + own_name(named->getName().str()) +
                                 "' is declared in the loop's head already; give one of them "
                                 "another name");
    }
}

void Walk::loop(const Stmt* node)
{
    Loop loop;
    const SourceManager& sources = context_.getSourceManager();
    const SourceLocation at = sources.getExpansionLoc(node->getBeginLoc());
    loop.line = static_cast<int>(sources.getSpellingLineNumber(at));
    loop.column = static_cast<int>(sources.getSpellingColumnNumber(at));
    loop.outer_trips = trips_;
    loop.token = token_at(node->getBeginLoc());
    const Expr* condition = nullptr;
    const VarDecl* counter = nullptr;
    if (const auto* repeat = dyn_cast<ForStmt>(node)) {
        condition = repeat->getCond();
        const LoopBounds bounds = loop_bounds(context_, repeat);
        loop.trips = bounds.trips;
        counter = bounds.counter;
        if (counter && bounds.trips) counters_[counter] = bounds.values;
        if (!condition) {
            const int open = token_at(repeat->getForLoc()) + 1;
            int semicolons = 0;
            int depth = 0;
            for (int i = open; i < static_cast<int>(description_.tokens.size()); ++i) {
                const std::string& text = description_.tokens[i].text;
                depth += text == "(" || text == "{" || text == "[" ? 1 : 0;
                depth -= text == ")" || text == "}" || text == "]" ? 1 : 0;
                if (depth == 1 && text == ";" && ++semicolons == 2) {
                    loop.insert_before = i;
                    break;
                }
            }
        }
        redeclared(repeat);
        if (repeat->getInc()) statement_expressions_.insert(repeat->getInc());
        if (const auto* start = dyn_cast_or_null<Expr>(repeat->getInit()))
            statement_expressions_.insert(start);
        if (repeat->getBody() && isa<Expr>(repeat->getBody()))
            statement_expressions_.insert(repeat->getBody());
        if (const auto* step = dyn_cast_or_null<UnaryOperator>(repeat->getInc()))
            if (condition && isa<BinaryOperator>(condition) &&
                (cast<BinaryOperator>(condition)->getOpcode() == BO_LT ||
                 cast<BinaryOperator>(condition)->getOpcode() == BO_GT || loop.trips))
                bounded_steps_.insert(step);
        if (loop.trips) bounded_steps_.insert(repeat->getInc());
    } else if (const auto* repeat = dyn_cast<WhileStmt>(node)) {
        condition = repeat->getCond();
        if (isa<Expr>(repeat->getBody())) statement_expressions_.insert(repeat->getBody());
    } else if (const auto* repeat = dyn_cast<DoStmt>(node)) {
        condition = repeat->getCond();
        if (isa<Expr>(repeat->getBody())) statement_expressions_.insert(repeat->getBody());
    }
    if (condition) statement_expressions_.erase(condition);
    if (condition) loop.condition = range_of(condition);
    bool is_true = !condition;
    if (condition && is_constant(condition))
        condition->EvaluateAsBooleanCondition(is_true, context_);
    const Stmt* body = nullptr;
    for (const Stmt* child : node->children())
        if (child && !isa<Expr, DeclStmt>(child)) body = child;
    loop.never_ends = is_true && !(body && leaves(body, true));
    const long before = trips_;
    trips_ = std::min(trips_ * std::max(loop.trips.value_or(1), 1L), 1L << 40);
    children(node);
    trips_ = before;
    if (counter) counters_.erase(counter);
    description_.functions[function_].loops.push_back(loop);
}

}  // namespace texture_tool
