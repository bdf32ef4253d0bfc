// The walk over calls: of the user's own functions, of OpenCL's, of the engine's.
#include "texture_tool/walk.hpp"

#include <algorithm>

#include "texture_tool/language.hpp"

namespace texture_tool {

using namespace clang;

namespace {

const StringLiteral* literal_of(const Expr* node)
{
    return dyn_cast<StringLiteral>(node->IgnoreParenImpCasts());
}

void remember(std::vector<std::string>& list, const std::string& name)
{
    if (std::find(list.begin(), list.end(), name) == list.end()) list.push_back(name);
}

}  // namespace

void Walk::call(const CallExpr* node)
{
    const FunctionDecl* callee = node->getDirectCallee();
    const auto* named = dyn_cast<DeclRefExpr>(node->getCallee()->IgnoreImpCasts());
    if (!callee || !named)
        return complain(node->getBeginLoc(),
                        "a function is called through a value or in parentheses; "
                        "call it by its name");
    handled_.insert(named);
    const auto own = function_numbers_.find(callee->getCanonicalDecl());
    const std::string name = callee->getName().str();
    if (own != function_numbers_.end()) return user_call(node, own->second);
    if (name == "readAttr" || name == "readSetting") return reader_call(node, name);
    if (name == "readOcclusion") return occlusion_call(node);
    if (is_engine_function(name) || is_library_function(name)) return library_call(node, name);
    complain(node->getBeginLoc(), "'" + name +
                                      "' is not available to textures; use OpenCL's math, "
                                      "geometric, common, relational and integer functions");
}

void Walk::user_call(const CallExpr* node, int callee)
{
    const int name_token = token_at(node->getCallee()->getBeginLoc());
    rename(name_token, description_.functions[callee].name, true);
    const std::vector<Parameter> parameters = description_.functions[callee].parameters;
    for (unsigned i = 0; i < node->getNumArgs() && i < parameters.size(); ++i)
        user_argument(node->getArg(i), parameters[i]);
    Call call;
    call.callee = callee;
    call.token = name_token;
    call.times = trips_;
    const Token& at = description_.tokens[name_token];
    call.line = at.line;
    call.column = at.column;
    if (function_ >= 0) description_.functions[function_].calls.push_back(call);
    Site& site = add(SiteKind::UserCall);
    site.token = name_token;
    site.number = callee;
    site.other = node->getNumArgs() > 0 ? "arguments" : "";
}

void Walk::user_argument(const Expr* argument, const Parameter& parameter)
{
    if (parameter.passing == Passing::Value) return expression(argument);
    const Expr* plain = argument->IgnoreParenImpCasts();
    const Parameter* passed = parameter_named(plain);
    const std::string wanted = "'" + parameter.name + "'";
    if (passed) {
        handled_.insert(plain);
        const bool fits =
            passed->passing == parameter.passing ||
            (parameter.passing == Passing::View && passed->passing == Passing::Array) ||
            (parameter.passing == Passing::Pointer && passed->passing == Passing::Array);
        if (!fits)
            return complain(
                argument->getBeginLoc(),
                "'" + passed->name + "' cannot be passed on as " + wanted +
                    "; pass an array of the caller's or the address of a local variable");
        if (parameter.passing == Passing::Array && *passed->length < *parameter.length)
            complain(argument->getBeginLoc(), wanted + " has " + std::to_string(*parameter.length) +
                                                  " elements and '" + passed->name + "' only " +
                                                  std::to_string(*passed->length) +
                                                  "; pass a longer array");
        const Passing from = passed->passing;
        const long length = passed->length.value_or(1);
        expression(argument);
        if (parameter.passing == Passing::View && from == Passing::Array) {
            Site& site = add(SiteKind::ViewArgument);
            site.range = range_of(argument);
            site.text = parameter.type;
            site.number = length;
            site.other = "local";
        }
        return;
    }
    if (const auto* address = dyn_cast<UnaryOperator>(plain)) {
        const Expr* operand = address->getSubExpr()->IgnoreParens();
        const Expr* base = operand;
        while (true) {
            if (const auto* field = dyn_cast<MemberExpr>(base))
                base = field->getBase()->IgnoreParenImpCasts();
            else if (const auto* element = dyn_cast<ArraySubscriptExpr>(base))
                base = element->getBase()->IgnoreParenImpCasts();
            else
                break;
        }
        const auto* reference = dyn_cast<DeclRefExpr>(base);
        const auto* variable = reference ? dyn_cast<VarDecl>(reference->getDecl()) : nullptr;
        const Parameter* of = parameter_named(base);
        const bool is_own = variable && variable->hasLocalStorage() &&
                            (!of || of->passing == Passing::Value ||
                             of->passing == Passing::Array || of->passing == Passing::Pointer);
        if (address->getOpcode() != UO_AddrOf || !is_own || parameter.passing == Passing::Array ||
            parameter.passing == Passing::Engine)
            return complain(argument->getBeginLoc(),
                            wanted + " needs " +
                                (parameter.passing == Passing::Array
                                     ? "an array"
                                     : "the address of a local variable") +
                                " of the caller's; declare one and pass it");
        handled_.insert(address);
        expression(argument);
        if (parameter.passing == Passing::View) {
            Site& site = add(SiteKind::ViewArgument);
            site.range = range_of(argument);
            site.text = parameter.type;
            site.number = 1;
            site.other = "local";
        }
        return;
    }
    const auto* array = context_.getAsConstantArrayType(plain->getType());
    if (!array || parameter.passing == Passing::Engine)
        return complain(argument->getBeginLoc(),
                        wanted + " is given something else than an array or the "
                                 "address of a local variable; pass one of these");
    const long length = static_cast<long>(array->getSize().getZExtValue());
    const Expr* base = plain;
    while (const auto* field = dyn_cast<MemberExpr>(base))
        base = field->getBase()->IgnoreParenImpCasts();
    while (const auto* element = dyn_cast<ArraySubscriptExpr>(base))
        base = element->getBase()->IgnoreParenImpCasts();
    const auto* reference = dyn_cast<DeclRefExpr>(base);
    const auto* variable = reference ? dyn_cast<VarDecl>(reference->getDecl()) : nullptr;
    const bool is_table = variable && !variable->hasLocalStorage();
    if (is_table && parameter.passing != Passing::View)
        return complain(argument->getBeginLoc(),
                        wanted + " may be written and is given a constant table; "
                                 "declare it const");
    if (parameter.passing == Passing::Array && length < *parameter.length)
        complain(argument->getBeginLoc(), wanted + " has " + std::to_string(*parameter.length) +
                                              " elements and this array only " +
                                              std::to_string(length) + "; pass a longer one");
    handled_.insert(plain);
    expression(argument);
    if (parameter.passing != Passing::View) return;
    Site& site = add(SiteKind::ViewArgument);
    site.range = range_of(argument);
    site.text = parameter.type;
    site.number = length;
    site.other = is_table ? "table" : "local";
}

void Walk::library_call(const CallExpr* node, const std::string& name)
{
    const FunctionDecl* callee = node->getDirectCallee();
    std::string widest;
    int width = -1;
    for (unsigned i = 0; i < node->getNumArgs(); ++i) {
        const Expr* argument = node->getArg(i);
        const QualType type = callee->getParamDecl(i)->getType();
        if (type->isPointerType()) {
            const Expr* plain = argument->IgnoreParenImpCasts();
            const auto* address = dyn_cast<UnaryOperator>(plain);
            const Parameter* passed = parameter_named(plain);
            if (address && address->getOpcode() == UO_AddrOf)
                handled_.insert(address);
            else if (passed && passed->passing == Passing::Pointer)
                handled_.insert(plain);
            else
                return complain(argument->getBeginLoc(), "'" + name +
                                                             "' writes here; give it the address "
                                                             "of a local variable");
            expression(argument);
            continue;
        }
        expression(argument);
        const auto* vector = type->getAs<ExtVectorType>();
        const int own_width = vector ? static_cast<int>(vector->getNumElements()) : 1;
        if (own_width > width) {
            width = own_width;
            widest = spelled_type(type);
        }
    }
    const int token = token_at(node->getCallee()->getBeginLoc());
    if (name == "tex2D" || name == "texture2D") {
        description_.reads_images = true;
        Site& site = add(SiteKind::ContextCall);
        site.token = token;
        site.text = node->getNumArgs() == 3 ? "tx_sample_flags" : "tx_sample";
        return;
    }
    Site& site = add(SiteKind::LibraryCall);
    site.token = token;
    if (is_engine_function(name)) {
        site.text = "tx_" + name;
        return;
    }
    std::string plain = plain_library_name(name);
    if (plain.size() > 4 && plain.substr(plain.size() - 4) == "_rtz")
        plain.resize(plain.size() - 4);
    if (plain.rfind("convert_float", 0) == 0 && plain.size() > 4 &&
        plain.substr(plain.size() - 4) == "_sat")
        plain.resize(plain.size() - 4);
    if (plain.rfind("convert_", 0) == 0 && plain.find("_sat") != std::string::npos &&
        widest.rfind("float", 0) == 0)
        plain.resize(plain.size() - 4);  // conversions of floats are always clamped
    site.text = "tx_" + plain + "_" + widest;
    if (plain == "select") site.text += "_" + spelled_type(callee->getParamDecl(2)->getType());
    const std::string element = widest.substr(0, widest.find_first_of("23481"));
    if (element != "float" && element != "int" && element != "uint")
        complain(node->getBeginLoc(), "'" + name + "' is there for float, int and uint, not for " +
                                          widest + "; convert the arguments");
}

void Walk::reader_call(const CallExpr* node, const std::string& name)
{
    const unsigned count = node->getNumArgs();
    const Expr* argument = node->getArg(count - 1);
    if (count == 2) {
        const Parameter* hit = parameter_named(node->getArg(0));
        if (!hit || hit->passing != Passing::Engine)
            return complain(node->getArg(0)->getBeginLoc(),
                            "this is not the hit; readAttr takes the name alone, or after the "
                            "parameter of type const SurfaceInfo*");
    }
    const StringLiteral* literal = literal_of(argument);
    if (!literal)
        return complain(argument->getBeginLoc(),
                        "the name must be written here as text, because what is "
                        "not asked for is not computed; write " +
                            name + "(\"...\")");
    const std::string written = literal->getString().str();
    Site site{SiteKind::Replace};
    site.range = range_of(node);
    if (name == "readSetting") {
        const std::string problem = setting_problem(written);
        if (!problem.empty()) return complain(argument->getBeginLoc(), problem);
        remember(description_.settings, written);
        site.text = "tx_setting_" + written + "(tx_context)";
        description_.sites.push_back(site);
        return;
    }
    if (written == "AO" || written == "AO0" || written == "AO1") {
        OcclusionRequest request;
        request.hemisphere = written == "AO1" ? "lower" : "upper";
        request.distance = 0.0;
        request.function = function_;
        size_t number = 0;
        for (; number < description_.occlusion.size(); ++number)
            if (description_.occlusion[number].hemisphere == request.hemisphere &&
                description_.occlusion[number].distance == 0.0)
                break;
        if (number == description_.occlusion.size()) description_.occlusion.push_back(request);
        site.text = "tx_occlusion(tx_context, " + std::to_string(number) + ")";
        description_.sites.push_back(site);
        return;
    }
    const std::string attribute = attribute_of(written);
    if (attribute.empty()) return complain(argument->getBeginLoc(), attribute_problem(written));
    remember(description_.attributes, attribute);
    site.text = "tx_attribute_" + attribute + "(tx_context)";
    description_.sites.push_back(site);
}

void Walk::occlusion_call(const CallExpr* node)
{
    const StringLiteral* literal = literal_of(node->getArg(0));
    OcclusionRequest request;
    std::string where = literal ? literal->getString().str() : "";
    const std::string same = " same_object";
    if (where.size() > same.size() && where.substr(where.size() - same.size()) == same) {
        request.same_object = true;
        where.resize(where.size() - same.size());
    }
    if (where != "upper" && where != "lower" && where != "both")
        return complain(
            node->getArg(0)->getBeginLoc(),
            "no such hemisphere; write \"upper\", "
            "\"lower\" or \"both\", with \" same_object\" after it where only the object itself "
            "occludes");
    request.hemisphere = where;
    request.function = function_;
    const Token& at = description_.tokens[token_at(node->getBeginLoc())];
    request.line = at.line;
    request.column = at.column;
    const Expr* distance = node->getArg(1);
    Expr::EvalResult result;
    const Parameter* parameter = parameter_named(distance);
    if (distance->EvaluateAsRValue(result, context_) && result.Val.isFloat())
        request.distance = result.Val.getFloat().convertToFloat();
    else if (parameter && parameter->passing == Passing::Value && parameter->type == "float")
        request.argument = parameter->name;
    else
        return complain(
            distance->getBeginLoc(),
            "the distance must be known before the texture runs; use a "
            "number or one of the texture's own float arguments, which another node may give");
    if (trips_ > 1)
        return complain(node->getBeginLoc(),
                        "occlusion is traced once for each request, before the texture; "
                        "ask for it outside of the loop");
    Site site{SiteKind::Replace};
    site.range = range_of(node);
    site.text = "tx_occlusion(tx_context, " + std::to_string(description_.occlusion.size()) + ")";
    description_.occlusion.push_back(request);
    description_.sites.push_back(site);
}

}  // namespace texture_tool
