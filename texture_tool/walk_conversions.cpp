// The walk over conversions, written and implied.
#include "texture_tool/walk.hpp"

namespace texture_tool {

using namespace clang;

void Walk::implicit_cast(const ImplicitCastExpr* node)
{
    const Expr* operand = node->getSubExpr();
    if (node->getCastKind() == CK_LValueToRValue || node->getCastKind() == CK_NoOp ||
        node->getCastKind() == CK_ArrayToPointerDecay ||
        node->getCastKind() == CK_AddressSpaceConversion)
        if (handled_.count(node)) handled_.insert(operand->IgnoreParenImpCasts());
    if (statement_expressions_.count(node)) statement_expressions_.insert(operand);
    if (node->getCastKind() == CK_FloatingToIntegral) return conversion(node, operand, -1);
    expression(operand);
    if (node->getCastKind() == CK_IntegralCast && node->getType()->isEnumeralType() &&
        !operand->getType()->isEnumeralType()) {
        Site& site = add(SiteKind::EnumCast);
        site.range = range_of(operand);
        site.text = own_name(node->getType().getUnqualifiedType().getAsString());
    }
}

void Walk::explicit_cast(const CStyleCastExpr* node)
{
    const Expr* operand = node->getSubExpr();
    types_in(node->getTypeInfoAsWritten());
    if (node->getType()->isAnyPointerType() || operand->getType()->isAnyPointerType())
        return complain(node->getBeginLoc(),
                        "a cast to or from a pointer; use as_uint and as_float for "
                        "the bits of a number");
    type_allowed(node->getType(), node->getBeginLoc(), "this cast");
    const int open = token_at(node->getLParenLoc());
    if (node->getCastKind() == CK_FloatingToIntegral) return conversion(node, operand, open);
    if (const auto* list = dyn_cast<InitListExpr>(operand->IgnoreImplicit())) {
        for (const Expr* value : list->inits()) expression(value);
        Site& site = add(SiteKind::VectorLiteral);
        site.token = open;
        site.token2 = matching_close(open);
        return;
    }
    if (statement_expressions_.count(node)) statement_expressions_.insert(operand);
    if (node->getCastKind() == CK_ToVoid) statement_expressions_.insert(operand);
    expression(operand);
}

// Of a float to an integer, which must not depend on the device.
void Walk::conversion(const Expr* node, const Expr* operand, int open)
{
    expression(operand);
    Expr::EvalResult result;
    if (node->EvaluateAsInt(result, context_) || in_constant_) return;
    const QualType type = node->getType();
    const bool is_wide_uint = type->isUnsignedIntegerType() && context_.getTypeSize(type) >= 32;
    Site& site = add(SiteKind::Convert);
    site.range = range_of(operand);
    site.token = open;
    site.text = is_wide_uint ? "tx_convert_uint_float" : "tx_convert_int_float";
    const std::string spelled = spelled_type(type);
    site.other = spelled == "int" || spelled == "uint" ? "" : spelled;
}

}  // namespace texture_tool
