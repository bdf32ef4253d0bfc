#include "texture_tool/order.hpp"

namespace texture_tool {

using namespace clang;

namespace {

// The variable that holds what an expression names: v of v.x, v[2], v.at[i].y.
const VarDecl* holder_of(const Expr* node)
{
    node = node->IgnoreParenCasts();
    if (const auto* named = dyn_cast<DeclRefExpr>(node)) return dyn_cast<VarDecl>(named->getDecl());
    if (const auto* member = dyn_cast<MemberExpr>(node)) return holder_of(member->getBase());
    if (const auto* element = dyn_cast<ArraySubscriptExpr>(node))
        return holder_of(element->getBase());
    if (const auto* component = dyn_cast<ExtVectorElementExpr>(node))
        return holder_of(component->getBase());
    if (const auto* unary = dyn_cast<UnaryOperator>(node)) return holder_of(unary->getSubExpr());
    return nullptr;
}

template<class Set>
void add(Set& to, const Set& from)
{
    to.insert(from.begin(), from.end());
}

}  // namespace

Order::Clash Order::clash_in(const Expr* whole)
{
    clash_ = {};
    used_by(whole);
    return clash_;
}

void Order::compare(const Used& changes, const Used& uses, const Expr* at)
{
    for (const VarDecl* variable : changes.changed)
        if (!clash_.variable && (uses.read.count(variable) || uses.changed.count(variable)))
            clash_ = {variable, at};
}

Order::Used Order::side_by_side(const Used& a, const Used& b, const Expr* at)
{
    compare(a, b, at);
    compare(b, a, at);
    Used both = a;
    add(both.read, b.read);
    add(both.changed, b.changed);
    return both;
}

// Of what is assigned to, or handed over for a result: its indexes are read, its holder changed.
Order::Used Order::changed_by(const Expr* target, bool is_read)
{
    Used used = used_by(target);
    if (const VarDecl* holder = holder_of(target)) {
        used.changed.insert(holder);
        if (!is_read) used.read.erase(holder);
    }
    return used;
}

// Arguments are computed in any order, and all before the function changes what it is handed.
Order::Used Order::used_by_call(const CallExpr* node)
{
    const FunctionDecl* callee = node->getDirectCallee();
    Used all;
    std::set<const VarDecl*> results;
    for (unsigned i = 0; i < node->getNumArgs(); ++i) {
        const Expr* argument = node->getArg(i);
        all = side_by_side(all, used_by(argument), node);
        if (!callee || i >= callee->getNumParams()) continue;
        const QualType type = callee->getParamDecl(i)->getType();
        if (type->isPointerType() && !type->getPointeeType().isConstQualified())
            results.insert(holder_of(argument));
    }
    results.erase(nullptr);
    add(all.changed, results);
    return all;
}

Order::Used Order::used_by_binary(const BinaryOperator* node)
{
    if (node->isLogicalOp() || node->isCommaOp()) {  // left before right
        Used both = used_by(node->getLHS());
        const Used right = used_by(node->getRHS());
        add(both.read, right.read);
        add(both.changed, right.changed);
        return both;
    }
    if (!node->isAssignmentOp())
        return side_by_side(used_by(node->getLHS()), used_by(node->getRHS()), node);
    // what is assigned changes last: only the left side's reads have no order
    Used left = changed_by(node->getLHS(), node->isCompoundAssignmentOp());
    const Used right = used_by(node->getRHS());
    compare(right, {left.read, {}}, node);
    add(left.read, right.read);
    add(left.changed, right.changed);
    return left;
}

Order::Used Order::used_by(const Expr* node)
{
    node = node->IgnoreParenImpCasts();
    if (const auto* named = dyn_cast<DeclRefExpr>(node)) {
        const auto* variable = dyn_cast<VarDecl>(named->getDecl());
        return variable ? Used{{variable}, {}} : Used{};
    }
    if (isa<UnaryExprOrTypeTraitExpr>(node)) return {};  // sizeof computes nothing
    if (const auto* call = dyn_cast<CallExpr>(node)) return used_by_call(call);
    if (const auto* binary = dyn_cast<BinaryOperator>(node)) return used_by_binary(binary);
    if (const auto* unary = dyn_cast<UnaryOperator>(node); unary && unary->isIncrementDecrementOp())
        return changed_by(unary->getSubExpr(), true);
    const bool is_ordered = isa<ConditionalOperator>(node);
    Used all;
    for (const Stmt* child : node->children())
        if (const auto* part = dyn_cast_or_null<Expr>(child)) {
            const Used used = used_by(part);
            if (is_ordered) {
                add(all.read, used.read);
                add(all.changed, used.changed);
            } else {
                all = side_by_side(all, used, node);
            }
        }
    return all;
}

}  // namespace texture_tool
