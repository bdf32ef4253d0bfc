#include "texture_tool/loop_bounds.hpp"

#include <cmath>

#include <clang/AST/Expr.h>

namespace texture_tool {

using namespace clang;

namespace {

constexpr long most_trips = 1L << 20;

const VarDecl* variable_of(const Expr* node)
{
    const auto* reference = dyn_cast<DeclRefExpr>(node->IgnoreParenImpCasts());
    return reference ? dyn_cast<VarDecl>(reference->getDecl()) : nullptr;
}

std::optional<double> constant(ASTContext& context, const Expr* node)
{
    Expr::EvalResult result;
    if (node->isValueDependent() || !node->EvaluateAsRValue(result, context) ||
        result.HasSideEffects)
        return {};
    if (result.Val.isInt())
        return result.Val.getInt().isSigned()
                   ? static_cast<double>(result.Val.getInt().getSExtValue())
                   : static_cast<double>(result.Val.getInt().getZExtValue());
    if (result.Val.isFloat()) {
        llvm::APFloat value = result.Val.getFloat();
        bool loses = false;
        value.convert(llvm::APFloat::IEEEdouble(), llvm::APFloat::rmNearestTiesToEven, &loses);
        return value.convertToDouble();
    }
    return {};
}

bool is_changed_in(const Stmt* node, const VarDecl* variable)
{
    if (!node) return false;
    if (const auto* unary = dyn_cast<UnaryOperator>(node))
        if ((unary->isIncrementDecrementOp() || unary->getOpcode() == UO_AddrOf) &&
            variable_of(unary->getSubExpr()) == variable)
            return true;
    if (const auto* binary = dyn_cast<BinaryOperator>(node))
        if (binary->isAssignmentOp() && variable_of(binary->getLHS()) == variable) return true;
    for (const Stmt* child : node->children())
        if (is_changed_in(child, variable)) return true;
    return false;
}

std::optional<double> start_of(ASTContext& context, const ForStmt* loop, const VarDecl*& counter)
{
    if (const auto* declared = dyn_cast_or_null<DeclStmt>(loop->getInit())) {
        if (!declared->isSingleDecl()) return {};
        counter = dyn_cast<VarDecl>(declared->getSingleDecl());
        return counter && counter->getInit() ? constant(context, counter->getInit())
                                             : std::optional<double>();
    }
    const auto* assigned = dyn_cast_or_null<BinaryOperator>(loop->getInit());
    if (!assigned || assigned->getOpcode() != BO_Assign) return {};
    counter = variable_of(assigned->getLHS());
    return counter ? constant(context, assigned->getRHS()) : std::optional<double>();
}

std::optional<double> step_of(ASTContext& context, const Expr* node, const VarDecl* counter)
{
    if (const auto* unary = dyn_cast_or_null<UnaryOperator>(node)) {
        if (variable_of(unary->getSubExpr()) != counter || !unary->isIncrementDecrementOp())
            return {};
        return unary->isIncrementOp() ? 1.0 : -1.0;
    }
    const auto* binary = dyn_cast_or_null<CompoundAssignOperator>(node);
    if (!binary || variable_of(binary->getLHS()) != counter) return {};
    const auto size = constant(context, binary->getRHS());
    if (size && binary->getOpcode() == BO_AddAssign) return *size;
    if (size && binary->getOpcode() == BO_SubAssign) return -*size;
    return {};
}

bool holds(BinaryOperatorKind relation, double a, double b)
{
    switch (relation) {
    case BO_LT:
        return a < b;
    case BO_LE:
        return a <= b;
    case BO_GT:
        return a > b;
    case BO_GE:
        return a >= b;
    default:
        return a != b;
    }
}

}  // namespace

LoopBounds loop_bounds(ASTContext& context, const ForStmt* loop)
{
    LoopBounds bounds;
    const VarDecl* counter = nullptr;
    const auto start = start_of(context, loop, counter);
    const auto* condition = dyn_cast_or_null<BinaryOperator>(loop->getCond());
    if (!start || !counter || !condition) return bounds;
    const BinaryOperatorKind relation = condition->getOpcode();
    if (!condition->isRelationalOp() && relation != BO_NE) return bounds;
    if (variable_of(condition->getLHS()) != counter) return bounds;
    const auto end = constant(context, condition->getRHS());
    const auto step = loop->getInc() ? step_of(context, loop->getInc(), counter) : std::nullopt;
    if (!end || !step || is_changed_in(loop->getBody(), counter)) return bounds;
    const bool is_float = counter->getType()->isRealFloatingType();
    if (!is_float && !counter->getType()->isIntegerType()) return bounds;
    const bool is_signed = counter->getType()->isSignedIntegerType();
    const double range = std::ldexp(1.0, static_cast<int>(context.getTypeSize(counter->getType())));
    const double lowest = is_signed ? -0.5 * range : 0.0;
    const double highest = (is_signed ? 0.5 * range : range) - 1.0;
    bounds.counter = counter;
    double value = *start;
    bounds.values = {static_cast<long>(value), static_cast<long>(value)};
    for (long trips = 0; trips <= most_trips; ++trips) {
        if (!holds(relation, value, *end)) {
            bounds.trips = trips;
            return bounds;
        }
        bounds.values = join(bounds.values, {static_cast<long>(value), static_cast<long>(value)});
        value = is_float ? static_cast<float>(static_cast<float>(value) + static_cast<float>(*step))
                         : value + *step;
        if (!is_float && (value < lowest || value > highest)) return bounds;
    }
    return bounds;
}

}  // namespace texture_tool
