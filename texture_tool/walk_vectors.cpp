// The walk over what takes values apart and puts them together: indexes, components, choices,
// lists.
#include "texture_tool/walk.hpp"

namespace texture_tool {

using namespace clang;

void Walk::subscript(const ArraySubscriptExpr* node)
{
    const Expr* base = node->getBase();
    const Expr* index = node->getIdx();
    if (base != node->getLHS())
        return complain(node->getBeginLoc(),
                        "the array stands inside the brackets; write array[index]");
    const Parameter* parameter = parameter_named(base);
    const Interval range = interval_of(index);
    const int close = token_at(node->getRBracketLoc());
    int open = close;
    for (int depth = 0; open >= 0; --open) {
        const std::string& text = description_.tokens[open].text;
        depth += text == "]" ? 1 : (text == "[" ? -1 : 0);
        if (depth == 0) break;
    }
    long length = -1;
    std::string view;
    const Expr* array = base->IgnoreParenImpCasts();
    if (base->getType()->isExtVectorType() || array->getType()->isExtVectorType()) {
        if (!array->isLValue() || isa<ExtVectorElementExpr>(array))
            return complain(node->getBeginLoc(),
                            "only a variable's component can be chosen by an index; "
                            "store the vector in a variable first");
        length = array->getType()->castAs<ExtVectorType>()->getNumElements();
        expression(base);
        expression(index);
        Site& site = add(SiteKind::Index);
        site.range = range_of(base);
        site.token = open;
        site.token2 = close;
        site.number = length;
        site.text = spelled_type(array->getType()->castAs<ExtVectorType>()->getElementType());
        return;
    }
    if (parameter) {
        if (parameter->passing == Passing::View)
            view = parameter->type;
        else if (parameter->passing == Passing::Array)
            length = *parameter->length;
        else
            return complain(node->getBeginLoc(),
                            "the length of '" + parameter->name + "' is not known; declare it as " +
                                parameter->name + "[N], or const where it is only read");
        if (parameter->length && range.low == range.high &&
            (range.low < 0 || range.low >= *parameter->length))
            complain(index->getExprLoc(),
                     "index " + std::to_string(range.low) + " is outside of '" + parameter->name +
                         "', which has " + std::to_string(*parameter->length) +
                         " elements; it reads the nearest one",
                     false);
        handled_.insert(array);
    } else if (const auto* type = context_.getAsConstantArrayType(array->getType())) {
        length = static_cast<long>(type->getSize().getZExtValue());
        if (range.high < 0 || range.low >= length)
            complain(
                index->getExprLoc(),
                (range.low == range.high ? "index " + std::to_string(range.low) : "the index") +
                    " is outside of an array of " + std::to_string(length) +
                    " elements; use 0 to " + std::to_string(length - 1));
        handled_.insert(array);
    } else {
        return complain(node->getBeginLoc(),
                        "only arrays are indexed; textures have no other pointers");
    }
    expression(base);
    expression(index);
    if (view.empty() && range.is_within(0, length - 1)) return;
    Site& site = add(view.empty() ? SiteKind::Index : SiteKind::ViewIndex);
    site.range = range_of(base);
    site.token = open;
    site.token2 = close;
    site.number = length;
    site.text = view;
}

void Walk::fill_swizzle(const ExtVectorElementExpr* node, Site& site) const
{
    llvm::SmallVector<uint32_t, 16> elements;
    node->getEncodedElementAccess(elements);
    site.range = range_of(node->getBase());
    site.token2 = token_at(node->getAccessorLoc());
    site.token = site.token2 - 1;
    site.indices.assign(elements.begin(), elements.end());
    site.number = node->getBase()->getType()->castAs<ExtVectorType>()->getNumElements();
}

void Walk::swizzle(const ExtVectorElementExpr* node)
{
    if (node->isArrow() || !node->getBase()->getType()->isExtVectorType()) {
        const Parameter* parameter = parameter_named(node->getBase());
        if (node->isArrow() && parameter && parameter->passing == Passing::Pointer) {
            handled_.insert(node->getBase()->IgnoreParenImpCasts());
            expression(node->getBase());
            if (node->getNumElements() > 1)
                complain(node->getAccessorLoc(),
                         "several components through ->; write (*" + parameter->name + ").xyz");
            return;
        }
        return complain(node->getBeginLoc(), "-> is for output parameters only; use a dot");
    }
    expression(node->getBase());
    Site site{SiteKind::Swizzle};
    fill_swizzle(node, site);
    description_.sites.push_back(site);
}

void Walk::swizzle_write(const ExtVectorElementExpr* node, const BinaryOperator* write)
{
    expression(node->getBase());
    expression(write->getRHS());
    if (node->isArrow())
        return complain(node->getAccessorLoc(),
                        "several components through ->; write (*p).xy = ...");
    if (node->containsDuplicateElements())
        return complain(node->getAccessorLoc(), "a component is written twice; name each once");
    if (isa<ExtVectorElementExpr>(node->getBase()->IgnoreParens()))
        return complain(node->getAccessorLoc(), "components of components are written; name the "
                                                "vector's own components");
    const auto* compound = dyn_cast<CompoundAssignOperator>(write);
    bool only_opencl = false;
    const std::string function =
        compound ? arithmetic_function(write->getOpcode(), node->getType(), nullptr,
                                       write->getRHS(), {}, only_opencl)
                 : "";
    if (!function.empty() && !only_opencl)
        return complain(write->getOperatorLoc(),
                        "write the components' new values with =: this operator "
                        "may divide by zero or shift too far");
    if (has_side_effects(node->getBase()) && compound)
        return complain(write->getOperatorLoc(),
                        "the left side is computed twice and changes something; "
                        "change it in a statement of its own");
    Site site{SiteKind::SwizzleWrite};
    fill_swizzle(node, site);
    site.range2 = range_of(write->getRHS());
    site.range3 = range_of(node);
    const int operation = token_at(write->getOperatorLoc());
    const std::string text = description_.tokens[operation].text;
    site.text = compound ? text.substr(0, text.size() - 1) : "";
    site.other = std::to_string(operation);
    description_.sites.push_back(site);
}

void Walk::choice(const ConditionalOperator* node)
{
    for (const Expr* side : {node->getTrueExpr(), node->getFalseExpr()})
        if (side->getType()->isAnyPointerType())
            return complain(node->getBeginLoc(),
                            "arrays are chosen by ?:; choose the elements instead");
    if (statement_expressions_.count(node))
        for (const Expr* side : {node->getTrueExpr(), node->getFalseExpr()})
            statement_expressions_.insert(side);
    expression(node->getCond());
    expression(node->getTrueExpr());
    expression(node->getFalseExpr());
    const QualType type = node->getType();
    const bool has_vector_condition = node->getCond()->getType()->isExtVectorType();
    if (!has_vector_condition && !type->isExtVectorType()) return;
    Site& site = add(SiteKind::VectorChoice);
    site.range = range_of(node->getCond());
    site.range2 = range_of(node->getTrueExpr());
    site.range3 = range_of(node->getFalseExpr());
    site.token = token_at(node->getQuestionLoc());
    site.token2 = token_at(node->getColonLoc());
    site.text = spelled_type(type);
    site.other = has_vector_condition ? "vector" : "";
    site.number = type->isExtVectorType() ? type->castAs<ExtVectorType>()->getNumElements() : 1;
}

void Walk::initialiser_list(const InitListExpr* node)
{
    if (spelled_type(node->getType()) == "sam2D")
        return complain(node->getBeginLoc(), "images come from the scene; give the texture an "
                                             "argument of type sam2D");
    if (const InitListExpr* written = node->isSemanticForm() ? node->getSyntacticForm() : node)
        for (const Expr* value : written->inits())
            if (const auto* designated = dyn_cast<DesignatedInitExpr>(value)) {
                const bool is_plain =
                    designated->size() == 1 && designated->getDesignator(0)->isFieldDesignator();
                complain(designated->getBeginLoc(),
                         is_plain
                             ? "initialisers by name are not C++'s where their order differs; list "
                               "the values in the order of the fields"
                             : "initialisers by index are not C++; list the values in order");
                return;
            }
    const bool is_implicit = token_at(node->getLBraceLoc()) < 0 ||
                             description_.tokens[token_at(node->getLBraceLoc())].text != "{";
    Range range;
    for (const Expr* value : node->inits()) {
        expression(value);
        if (isa<ImplicitValueInitExpr>(value)) continue;
        const Range one = range_of(value);
        if (range.last < 0) range.first = one.first;
        range.last = std::max(range.last, one.last);
    }
    if (!is_implicit || range.last < 0) return;
    Site& site = add(SiteKind::ImplicitList);
    site.range = range;
}

}  // namespace texture_tool
