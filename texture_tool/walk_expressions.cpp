// The walk over expressions; children are walked before their parent's site is recorded, so that
// rewriting goes from the inside out.
#include "texture_tool/walk.hpp"

#include <cerrno>
#include <clang/AST/ExprCXX.h>
#include <cstdlib>

#include "texture_tool/language.hpp"

namespace texture_tool {

using namespace clang;

namespace {

const char* arithmetic_name(BinaryOperatorKind kind)
{
    switch (kind) {
    case BO_Mul:
    case BO_MulAssign:
        return "multiply";
    case BO_Div:
    case BO_DivAssign:
        return "divide";
    case BO_Rem:
    case BO_RemAssign:
        return "modulo";
    case BO_Add:
    case BO_AddAssign:
        return "add";
    case BO_Sub:
    case BO_SubAssign:
        return "subtract";
    case BO_Shl:
    case BO_ShlAssign:
        return "shift_left";
    case BO_Shr:
    case BO_ShrAssign:
        return "shift_right";
    default:
        return "";
    }
}

const ExtVectorElementExpr* as_swizzle(const Expr* node)
{
    const auto* swizzle = dyn_cast<ExtVectorElementExpr>(node->IgnoreParens());
    return swizzle;
}

}  // namespace

bool Walk::is_constant(const Expr* node) const
{
    Expr::EvalResult result;
    return !node->isValueDependent() && node->EvaluateAsRValue(result, context_) &&
           !result.HasSideEffects;
}

Interval Walk::interval_of(const Expr* node) const
{
    const Expr* plain = node->IgnoreParens();
    const QualType type = plain->getType();
    Interval full;
    if (type->isIntegerType() && !type->isExtVectorType()) {
        const unsigned bits = static_cast<unsigned>(context_.getTypeSize(type));
        if (bits <= 32) {
            const long range = 1L << bits;
            full = type->isSignedIntegerOrEnumerationType() ? Interval{-range / 2, range / 2 - 1}
                                                            : Interval{0, range - 1};
        }
    }
    Expr::EvalResult result;
    if (plain->getType()->isIntegerType() && plain->EvaluateAsInt(result, context_)) {
        const long value = static_cast<long>(result.Val.getInt().getExtValue());
        return {value, value};
    }
    if (const auto* cast = dyn_cast<ImplicitCastExpr>(plain)) {
        if (cast->getCastKind() == CK_LValueToRValue || cast->getCastKind() == CK_IntegralCast ||
            cast->getCastKind() == CK_NoOp) {
            const Interval inner = interval_of(cast->getSubExpr());
            return inner.is_within(full.low, full.high) ? inner : full;
        }
        return full;
    }
    if (const auto* reference = dyn_cast<DeclRefExpr>(plain)) {
        const auto known = counters_.find(dyn_cast<VarDecl>(reference->getDecl()));
        return known == counters_.end() ? full : known->second;
    }
    const auto* binary = dyn_cast<BinaryOperator>(plain);
    if (!binary || !type->isIntegerType()) return full;
    if (binary->isComparisonOp() || binary->isLogicalOp()) return {0, 1};
    const Interval a = interval_of(binary->getLHS());
    const Interval b = interval_of(binary->getRHS());
    Interval both = full;
    if (binary->getOpcode() == BO_Add) both = texture_tool::add(a, b);
    if (binary->getOpcode() == BO_Sub) both = subtract(a, b);
    if (binary->getOpcode() == BO_Mul) both = multiply(a, b);
    if (binary->getOpcode() == BO_And) {
        if (b.low >= 0)
            both = {0, a.low >= 0 ? std::min(a.high, b.high) : b.high};
        else if (a.low >= 0)
            both = {0, a.high};
    }
    if (binary->getOpcode() == BO_Rem && b.low > 0)
        both = {a.low >= 0 ? 0 : 1 - b.high, b.high - 1};
    if (binary->getOpcode() == BO_Shr && b.low == b.high && b.low >= 0 && b.low < 32)
        both = {a.low >> b.low, a.high >> b.low};
    return both.is_within(full.low, full.high) ? both : full;
}

bool Walk::has_side_effects(const Expr* node) const { return node->HasSideEffects(context_); }

const Parameter* Walk::parameter_named(const Expr* node) const
{
    const auto* reference = dyn_cast<DeclRefExpr>(node->IgnoreParenImpCasts());
    const auto* declaration = reference ? dyn_cast<ParmVarDecl>(reference->getDecl()) : nullptr;
    const auto found = parameter_numbers_.find(declaration);
    if (!declaration || found == parameter_numbers_.end()) return nullptr;
    return &description_.functions[found->second.first].parameters[found->second.second];
}

void Walk::expression(const Expr* node)
{
    const Level level(depth_);
    if (is_too_deep(node)) return;
    if (const auto* value = dyn_cast<DeclRefExpr>(node)) return reference(value);
    if (const auto* value = dyn_cast<CallExpr>(node)) return call(value);
    if (const auto* value = dyn_cast<ImplicitCastExpr>(node)) return implicit_cast(value);
    if (const auto* value = dyn_cast<CStyleCastExpr>(node)) return explicit_cast(value);
    if (const auto* value = dyn_cast<BinaryOperator>(node))
        return value->isAssignmentOp() ? assignment(value) : binary(value);
    if (const auto* value = dyn_cast<UnaryOperator>(node)) return unary(value);
    if (const auto* value = dyn_cast<ArraySubscriptExpr>(node)) return subscript(value);
    if (const auto* value = dyn_cast<ExtVectorElementExpr>(node)) return swizzle(value);
    if (const auto* value = dyn_cast<ConditionalOperator>(node)) return choice(value);
    if (const auto* value = dyn_cast<InitListExpr>(node)) return initialiser_list(value);
    if (const auto* value = dyn_cast<MemberExpr>(node)) return member(value);
    if (const auto* constant = dyn_cast<ConstantExpr>(node))
        return initialiser(constant->getSubExpr(), true);
    if (isa<ParenExpr>(node)) {
        if (statement_expressions_.count(node))
            for (const Stmt* child : node->children()) statement_expressions_.insert(child);
        return children(node);
    }
    if (isa<IntegerLiteral>(node)) {
        const int token = token_at(node->getBeginLoc());
        errno = 0;
        if (token >= 0 && strtoull(description_.tokens[token].text.c_str(), nullptr, 0) > 0 &&
            errno == ERANGE)
            complain(node->getBeginLoc(), "this number needs more than 64 bits; write a smaller "
                                          "one, or a float");
        return;
    }
    if (isa<CharacterLiteral>(node) || isa<ImplicitValueInitExpr>(node)) return;
    if (const auto* literal = dyn_cast<FloatingLiteral>(node)) {
        const int token = token_at(literal->getBeginLoc());
        if (spelled_type(literal->getType()) != "float" &&
            (token < 0 ||
             isalpha(static_cast<unsigned char>(description_.tokens[token].text.back()))))
            complain(literal->getBeginLoc(), "this number is not a float; end it with f");
        Site& site = add(SiteKind::FloatLiteral);
        site.token = token;
        return;
    }
    if (const auto* size = dyn_cast<UnaryExprOrTypeTraitExpr>(node)) {
        Expr::EvalResult result;
        if (size->getKind() != UETT_SizeOf || !size->EvaluateAsInt(result, context_))
            return complain(node->getBeginLoc(),
                            "this is not part of the language; only sizeof is");
        if (!size->isArgumentType() && parameter_named(size->getArgumentExpr()) &&
            parameter_named(size->getArgumentExpr())->passing != Passing::Value)
            complain(node->getBeginLoc(),
                     "sizeof of an array parameter is the size of a pointer; pass "
                     "the length as another parameter");
        Site& site = add(SiteKind::Replace);
        site.range = range_of(node);
        site.text = std::to_string(result.Val.getInt().getZExtValue()) + "ul";
        return;
    }
    if (const auto* literal = dyn_cast<CompoundLiteralExpr>(node)) {
        types_in(literal->getTypeSourceInfo());
        if (literal->getType()->isArrayType())
            return complain(node->getBeginLoc(), "an array without a name; declare a local array");
        const auto* list = dyn_cast<InitListExpr>(literal->getInitializer());
        const int brace = list ? token_at(list->getLBraceLoc()) : -1;
        if (list && brace >= 0 && description_.tokens[brace].text == "(")
            for (const Expr* value : list->inits()) expression(value);
        else
            expression(literal->getInitializer());
        Site& site = add(SiteKind::CompoundLiteral);
        site.token = token_at(literal->getLParenLoc());
        site.token2 = matching_close(site.token);
        return;
    }
    if (isa<CXXBoolLiteralExpr>(node)) return;
    if (isa<StringLiteral>(node))
        return complain(node->getBeginLoc(),
                        "text is only for the names in readAttr, readSetting and "
                        "readOcclusion; use numbers");
    if (isa<StmtExpr>(node) || isa<BinaryConditionalOperator>(node) || isa<AddrLabelExpr>(node))
        return complain(node->getBeginLoc(),
                        "this is an extension of some compilers; write it in C99");
    complain(node->getBeginLoc(),
             "this expression is not part of the language; write it in C99 with "
             "OpenCL's vectors");
}

void Walk::reference(const DeclRefExpr* node)
{
    const ValueDecl* target = node->getDecl();
    const std::string name = target->getName().str();
    if (isa<FunctionDecl>(target) && !handled_.count(node))
        return complain(node->getBeginLoc(),
                        "'" + own_name(name) +
                            "' is a function and not called here; functions are "
                            "not values");
    if (!is_users(target)) return;
    const auto* variable = dyn_cast<VarDecl>(target);
    if (variable && variable == initialised_)
        complain(node->getBeginLoc(), "'" + own_name(name) +
                                          "' is read where its first value is computed; declare "
                                          "it alone (it is then 0), and assign");
    const bool is_static_table = variable && variable->isStaticLocal();
    const DeclContext* home = target->getDeclContext();
    if (isa<EnumConstantDecl>(target)) home = cast<EnumDecl>(home)->getDeclContext();
    const bool is_global = home->isTranslationUnit();
    if (is_static_table) {
        Site& site = add(SiteKind::Name);
        site.token = token_at(node->getLocation());
        site.text = own_name(name);
        site.number = 2;  // hoisted in OpenCL
        site.range.first = token_at(variable->getLocation());
    } else {
        rename(token_at(node->getLocation()), name, is_global);
    }
    if (handled_.count(node)) return;
    const Parameter* parameter = parameter_named(node);
    if (parameter && parameter->passing != Passing::Value)
        complain(node->getBeginLoc(),
                 parameter->passing == Passing::Engine
                     ? "'" + parameter->name + "' only goes to readAttr and to functions"
                     : "'" + parameter->name + "' is used as a pointer; write " + parameter->name +
                           "[i], *" + parameter->name + " or pass it on");
    else if (node->getType()->isArrayType())
        complain(node->getBeginLoc(), "the array '" + name +
                                          "' is used as a pointer; index it or pass "
                                          "it to a function");
}

void Walk::member(const MemberExpr* node)
{
    const Expr* base = node->getBase();
    const auto* field = dyn_cast<FieldDecl>(node->getMemberDecl());
    if (spelled_type(node->isArrow() ? base->getType()->getPointeeType() : base->getType()) ==
        "sam2D")
        return complain(node->getMemberLoc(), "an image has no fields; read it with tex2D");
    if (node->isArrow()) {
        const Parameter* parameter = parameter_named(base);
        if (!parameter || parameter->passing == Passing::Engine)
            return complain(node->getBeginLoc(), "-> is for output parameters only; use a dot");
        handled_.insert(base->IgnoreParenImpCasts());
    }
    expression(base);
    if (field && is_users(field))
        rename(token_at(node->getMemberLoc()), field->getName().str(), false);
    if (node->getType()->isArrayType() && !handled_.count(node))
        complain(node->getMemberLoc(), "this array is used as a pointer; index it or pass it to a "
                                       "function");
}

// The function that gives `left kind right` one result, or "" where C's operator already does.
std::string Walk::arithmetic_function(BinaryOperatorKind kind, QualType type, const Expr* left,
                                      const Expr* right, QualType count, bool& only_opencl) const
{
    const std::string spelled = spelled_type(type);
    const bool is_int = spelled.rfind("int", 0) == 0;
    const bool is_uint = spelled.rfind("uint", 0) == 0;
    if (in_constant_ || *arithmetic_name(kind) == '\0') return "";
    const bool is_scalar = !type->isExtVectorType();
    const Interval b = interval_of(right->IgnoreParenImpCasts()->getType()->isExtVectorType()
                                       ? right
                                       : right->IgnoreImpCasts());
    const Interval a = left ? interval_of(left) : Interval();
    only_opencl = false;
    switch (kind) {
    case BO_Div:
    case BO_DivAssign:
    case BO_Rem:
    case BO_RemAssign:
        if (!type->hasIntegerRepresentation()) return "";
        if (b.low > 0 || b.high < -1) return "";
        break;
    case BO_Shl:
    case BO_ShlAssign:
    case BO_Shr:
    case BO_ShrAssign:
        if (b.is_within(0, 31)) return "";
        break;
    default:
        if (!is_int) return "";
        only_opencl = true;
        if (is_scalar && (kind == BO_Add || kind == BO_AddAssign) &&
            texture_tool::add(a, b).is_within(-2147483648L, 2147483647L))
            return "";
        if (is_scalar && (kind == BO_Sub || kind == BO_SubAssign) &&
            subtract(a, b).is_within(-2147483648L, 2147483647L))
            return "";
        if (is_scalar && (kind == BO_Mul || kind == BO_MulAssign) &&
            multiply(a, b).is_within(-2147483648L, 2147483647L))
            return "";
    }
    if (!is_int && !is_uint) return "?";
    (void)count;
    return std::string("tx_") + arithmetic_name(kind) + "_" + spelled;
}

void Walk::binary(const BinaryOperator* node)
{
    const BinaryOperatorKind kind = node->getOpcode();
    if (kind == BO_Comma) {
        statement_expressions_.insert(node->getLHS());
        if (statement_expressions_.count(node)) statement_expressions_.insert(node->getRHS());
    }
    for (const Expr* side : {node->getLHS(), node->getRHS()})
        if (side->getType()->isAnyPointerType())
            return complain(node->getOperatorLoc(),
                            "arithmetic with pointers and arrays; use an index: "
                            "name[i]");
    expression(node->getLHS());
    expression(node->getRHS());
    if (in_constant_ && node->isShiftOp() && !interval_of(node->getRHS()).is_within(0, 31))
        return complain(node->getOperatorLoc(),
                        "a constant is shifted by more than 31 or less than 0, which compilers "
                        "take differently; write its value");
    bool only_opencl = false;
    const std::string function =
        arithmetic_function(kind, node->getType(), node->getLHS(), node->getRHS(), {}, only_opencl);
    if (function.empty()) return;
    if (function == "?") {
        complain(node->getOperatorLoc(),
                 "this operator may divide by zero or shift too far in a type "
                 "that is not int or uint; convert the operands to int");
        return;
    }
    if (only_opencl && is_constant(node)) return;
    Expr::EvalResult divisor;
    if ((kind == BO_Div || kind == BO_Rem) && node->getRHS()->EvaluateAsInt(divisor, context_) &&
        divisor.Val.getInt() == 0)
        complain(node->getOperatorLoc(),
                 "division by zero gives 0 (x % 0 gives x) on every device; "
                 "remove it or test the divisor",
                 false);
    Site& site = add(SiteKind::Binary);
    site.range = range_of(node->getLHS());
    site.range2 = range_of(node->getRHS());
    site.token = token_at(node->getOperatorLoc());
    site.text = function;
    site.only_opencl = only_opencl;
}

void Walk::assignment(const BinaryOperator* node)
{
    const BinaryOperatorKind kind = node->getOpcode();
    const Expr* left = node->getLHS();
    if (const ExtVectorElementExpr* swizzle = as_swizzle(left))
        if (swizzle->getNumElements() > 1) return swizzle_write(swizzle, node);
    if (const Parameter* parameter = parameter_named(left))
        if (parameter->passing != Passing::Value)
            return complain(node->getOperatorLoc(), "'" + parameter->name +
                                                        "' is assigned another "
                                                        "array; assign to *" +
                                                        parameter->name + " or to its elements");
    expression(left);
    expression(node->getRHS());
    const auto* compound = dyn_cast<CompoundAssignOperator>(node);
    if (!compound) return watch(node->getRHS());
    if (left->getType()->isEnumeralType())
        return complain(node->getOperatorLoc(), "an enum is calculated with; use an int");
    bool only_opencl = false;
    std::string function = arithmetic_function(kind, compound->getComputationResultType(), nullptr,
                                               node->getRHS(), {}, only_opencl);
    std::string conversion;
    if (left->getType()->isIntegerType() &&
        compound->getComputationResultType()->isRealFloatingType())
        conversion = "tx_convert_" +
                     std::string(left->getType()->isUnsignedIntegerType() ? "uint" : "int") +
                     "_float";
    if (bounded_steps_.count(node)) return;
    if (function == "?")
        return complain(node->getOperatorLoc(),
                        "this operator may divide by zero or shift too far in a "
                        "type that is not int or uint; use int");
    if (function.empty() && conversion.empty()) return;
    if (has_side_effects(left))
        return complain(node->getOperatorLoc(),
                        "the left side is computed twice and changes something; "
                        "change it in a statement of its own");
    Site& site = add(SiteKind::CompoundBinary);
    site.range = range_of(left);
    site.range2 = range_of(node->getRHS());
    site.token = token_at(node->getOperatorLoc());
    site.text = function;
    site.other = conversion;
    site.only_opencl = only_opencl && conversion.empty();
    site.number = statement_expressions_.count(node) ? 0 : 1;
}

void Walk::unary(const UnaryOperator* node)
{
    const Expr* operand = node->getSubExpr();
    switch (node->getOpcode()) {
    case UO_AddrOf:
        expression(operand);
        if (!handled_.count(node))
            complain(node->getOperatorLoc(), "the address is only taken of a local variable, as an "
                                             "argument for an output parameter");
        return;
    case UO_Deref: {
        const Parameter* parameter = parameter_named(operand);
        if (!parameter || parameter->passing == Passing::Engine ||
            parameter->passing == Passing::Value)
            return complain(node->getOperatorLoc(),
                            "* is for output parameters only; textures have "
                            "no other pointers");
        const bool is_view = parameter->passing == Passing::View;
        const std::string type = parameter->type;
        handled_.insert(operand->IgnoreParenImpCasts());
        expression(operand);
        if (!is_view) return;
        Site& site = add(SiteKind::ViewFirst);
        site.token = token_at(node->getOperatorLoc());
        site.range = range_of(operand);
        site.text = type;
        return;
    }
    case UO_PreInc:
    case UO_PreDec:
    case UO_PostInc:
    case UO_PostDec: {
        if (as_swizzle(operand) && as_swizzle(operand)->getNumElements() > 1)
            return complain(node->getOperatorLoc(), "several components are stepped at once; write "
                                                    "v.xy += 1");
        if (const Parameter* parameter = parameter_named(operand))
            if (parameter->passing != Passing::Value)
                return complain(node->getOperatorLoc(),
                                "arithmetic with pointers and arrays; use an "
                                "index: name[i]");
        expression(operand);
        const std::string type = spelled_type(operand->getType());
        if (operand->getType()->isEnumeralType())
            return complain(node->getOperatorLoc(), "an enum is stepped; use an int");
        if (type.rfind("int", 0) != 0 || bounded_steps_.count(node)) return;
        if (has_side_effects(operand))
            return complain(node->getOperatorLoc(),
                            "the operand is computed twice and changes "
                            "something; change it in a statement of its own");
        Site& site = add(SiteKind::Step);
        site.token = token_at(node->getOperatorLoc());
        site.range = range_of(operand);
        site.text = type;
        site.other = node->isIncrementOp() ? "add" : "subtract";
        site.number = statement_expressions_.count(node) ? 2 : (node->isPostfix() ? 1 : 0);
        site.only_opencl = true;
        return;
    }
    case UO_Minus: {
        expression(operand);
        const std::string type = spelled_type(node->getType());
        if (type.rfind("int", 0) != 0 || is_constant(node) ||
            interval_of(operand).low > -2147483648L)
            return;
        Site& site = add(SiteKind::Negate);
        site.token = token_at(node->getOperatorLoc());
        site.range = range_of(operand);
        site.text = "tx_negate_" + type;
        site.only_opencl = true;
        return;
    }
    case UO_Plus:
    case UO_Not:
    case UO_LNot:
        return expression(operand);
    case UO_Extension:
        return expression(operand);
    default:
        complain(node->getOperatorLoc(),
                 "this operator is an extension of some compilers; write it "
                 "in C99");
    }
}

}  // namespace texture_tool
