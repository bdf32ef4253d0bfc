// The walk over declarations.
#include "texture_tool/walk.hpp"

#include <algorithm>

#include <clang/AST/Attr.h>
#include <clang/AST/TypeLoc.h>
#include <clang/Basic/SourceManager.h>

#include "texture_tool/language.hpp"

namespace texture_tool {

using namespace clang;

Walk::Walk(ASTContext& context, const std::map<unsigned, int>& numbers,
           const std::map<std::string, std::string>& own_names, Description& description)
    : context_(context), numbers_(numbers), description_(description)
{
    for (const auto& [name, other] : own_names) real_names_[other] = name;
}

void Walk::run()
{
    std::vector<const FunctionDecl*> functions;
    for (const Decl* declaration : context_.getTranslationUnitDecl()->decls()) {
        if (!is_users(declaration)) continue;
        if (const auto* function = dyn_cast<FunctionDecl>(declaration)) {
            declare_function(function);
            functions.push_back(function);
        } else if (const auto* variable = dyn_cast<VarDecl>(declaration)) {
            file_variable(variable);
        } else if (const auto* type = dyn_cast<RecordDecl>(declaration)) {
            record(type);
        } else if (const auto* enumeration = dyn_cast<EnumDecl>(declaration)) {
            rename(token_at(enumeration->getLocation()), enumeration->getName().str(), true);
            for (const EnumConstantDecl* constant : enumeration->enumerators()) {
                rename(token_at(constant->getLocation()), constant->getName().str(), true);
                if (constant->getInitExpr()) initialiser(constant->getInitExpr(), true);
            }
        } else if (const auto* name = dyn_cast<TypedefDecl>(declaration)) {
            type_allowed(name->getUnderlyingType(), name->getLocation(), "a type");
            rename(token_at(name->getLocation()), name->getName().str(), true);
            types_in(name->getTypeSourceInfo());
        } else if (!isa<EmptyDecl>(declaration)) {
            complain(declaration->getLocation(),
                     "this declaration is not part of the language; only functions, constants, "
                     "structs, unions, enums and typedefs are");
        }
    }
    for (const FunctionDecl* function : functions) {
        if (!function->doesThisDeclarationHaveABody()) continue;
        function_ = function_numbers_[function->getCanonicalDecl()];
        trips_ = 1;
        statement(function->getBody());
    }
}

bool Walk::is_users(const Decl* declaration) const
{
    const SourceManager& sources = context_.getSourceManager();
    const SourceLocation at = sources.getExpansionLoc(declaration->getLocation());
    return at.isValid() && sources.isInMainFile(at);
}

int Walk::token_at(SourceLocation at) const
{
    const auto found = numbers_.find(at.getRawEncoding());
    return found == numbers_.end() ? -1 : found->second;
}

Range Walk::range_of(SourceRange range) const
{
    return {token_at(range.getBegin()), token_at(range.getEnd())};
}

Range Walk::range_of(const Stmt* node) const { return range_of(node->getSourceRange()); }

int Walk::find_token(int from, int to, const std::string& text) const
{
    for (int i = std::max(from, 0); i <= to && i < static_cast<int>(description_.tokens.size());
         ++i)
        if (description_.tokens[i].text == text) return i;
    return -1;
}

int Walk::matching_close(int open) const
{
    int depth = 0;
    for (int i = open; i >= 0 && i < static_cast<int>(description_.tokens.size()); ++i) {
        const std::string& text = description_.tokens[i].text;
        if (text == "(" || text == "[" || text == "{") ++depth;
        if (text == ")" || text == "]" || text == "}") --depth;
        if (depth == 0) return i;
    }
    return -1;
}

Site& Walk::add(SiteKind kind)
{
    description_.sites.push_back({kind});
    return description_.sites.back();
}

void Walk::complain(SourceLocation at, const std::string& text, bool is_error)
{
    const SourceManager& sources = context_.getSourceManager();
    const SourceLocation place = sources.getExpansionLoc(at);
    description_.problems.push_back({static_cast<int>(sources.getSpellingLineNumber(place)),
                                     static_cast<int>(sources.getSpellingColumnNumber(place)),
                                     is_error, text});
}

std::string Walk::own_name(const std::string& name) const
{
    const auto real = real_names_.find(name);
    return real == real_names_.end() ? name : real->second;
}

void Walk::rename(int token, const std::string& name, bool is_global)
{
    if (token < 0 || name.empty()) return;
    const std::string real = own_name(name);
    if (!is_global && !needs_other_name(real)) return;
    Site& site = add(SiteKind::Name);
    site.token = token;
    site.text = real;
    site.number = is_global ? 1 : 0;
}

std::string Walk::spelled_type(QualType type) const
{
    const QualType plain = type.getCanonicalType().getUnqualifiedType();
    if (const auto* vector = plain->getAs<ExtVectorType>()) {
        const std::string element = spelled_type(vector->getElementType());
        return element.empty() ? "" : element + std::to_string(vector->getNumElements());
    }
    if (const auto* record = plain->getAs<RecordType>()) {
        const std::string name = record->getDecl()->getName().str();
        return name == "sam2D_" ? "sam2D" : "";
    }
    if (plain->isEnumeralType()) return "int";
    const auto* builtin = plain->getAs<BuiltinType>();
    if (!builtin) return "";
    switch (builtin->getKind()) {
    case BuiltinType::Float:
        return "float";
    case BuiltinType::Int:
        return "int";
    case BuiltinType::UInt:
        return "uint";
    case BuiltinType::Short:
        return "short";
    case BuiltinType::UShort:
        return "ushort";
    case BuiltinType::SChar:
    case BuiltinType::Char_S:
        return "char";
    case BuiltinType::UChar:
        return "uchar";
    case BuiltinType::Long:
        return "long";
    case BuiltinType::ULong:
        return "ulong";
    case BuiltinType::Bool:
        return "bool";
    default:
        return "";
    }
}

bool Walk::holds_image(QualType type) const
{
    type = context_.getBaseElementType(type);
    if (spelled_type(type) == "sam2D") return true;
    const RecordDecl* record = type->getAsRecordDecl();
    return record &&
           std::any_of(record->field_begin(), record->field_end(),
                       [&](const FieldDecl* field) { return holds_image(field->getType()); });
}

void Walk::type_allowed(QualType type, SourceLocation at, const std::string& what)
{
    const QualType plain = type.getCanonicalType();
    if (plain.isVolatileQualified())
        complain(at, what + " is volatile, which textures need not be; remove the word");
    if (const auto* array = context_.getAsArrayType(plain)) {
        if (!isa<ConstantArrayType>(array) && !isa<IncompleteArrayType>(array))
            complain(at, what + " has a length that is only known when it runs; give a constant");
        return type_allowed(array->getElementType(), at, what);
    }
    if (plain->isFunctionPointerType())
        complain(at, what + " points to a function, which GPUs lack; call the function by name");
    else if (plain->isAnyPointerType())
        complain(at, what +
                         " is a pointer; textures have values, arrays by their names, and output "
                         "parameters only");
    else if (plain->isRealFloatingType() && spelled_type(plain) != "float")
        complain(at, what + " is not of a type that every device has; use float");
    else if (plain->isAnyComplexType() || plain->isBlockPointerType() || plain->isImageType() ||
             plain->isSamplerT() || plain->isAtomicType())
        complain(at, what + " is not of a type of the language; use numbers, vectors, sam2D, "
                            "structs and arrays");
}

// Names of user types inside a written type.
void Walk::types_in(const TypeSourceInfo* written)
{
    if (!written) return;
    for (TypeLoc at = written->getTypeLoc(); at; at = at.getNextTypeLoc()) {
        const NamedDecl* named = nullptr;
        SourceLocation name_at;
        if (const auto name = at.getAs<TypedefTypeLoc>()) {
            named = name.getTypedefNameDecl();
            name_at = name.getNameLoc();
        } else if (const auto tag = at.getAs<TagTypeLoc>()) {
            named = tag.getDecl();
            name_at = tag.getNameLoc();
        }
        if (named && is_users(named) && named->getDeclContext()->isTranslationUnit() &&
            named->getLocation() != name_at)
            rename(token_at(name_at), named->getName().str(), true);
    }
}

void Walk::record(const RecordDecl* type)
{
    const bool is_global = type->getDeclContext()->isTranslationUnit();
    if (!type->getName().empty())
        rename(token_at(type->getLocation()), type->getName().str(), is_global);
    if (!type->isThisDeclarationADefinition()) return;
    for (const Decl* member : type->decls()) {
        if (const auto* inner = dyn_cast<RecordDecl>(member)) {
            record(inner);
            continue;
        }
        const auto* field = dyn_cast<FieldDecl>(member);
        if (!field) continue;
        if (field->isBitField())
            complain(field->getLocation(),
                     "bit fields differ between compilers; use shifts and masks");
        type_allowed(field->getType(), field->getLocation(),
                     "the field '" + field->getName().str() + "'");
        if (type->isUnion() && holds_image(field->getType()))
            complain(field->getLocation(), "an image shares its bytes with numbers; keep images in "
                                           "variables, arrays and structs");
        rename(token_at(field->getLocation()), field->getName().str(), false);
        types_in(field->getTypeSourceInfo());
    }
}

void Walk::file_variable(const VarDecl* variable)
{
    const std::string name = variable->getName().str();
    if (!context_.getBaseElementType(variable->getType()).isConstQualified())
        return complain(variable->getLocation(),
                        "'" + name +
                            "' could be written by one path and read by another; make it "
                            "const, or a local variable");
    if (!variable->hasInit() || variable->getStorageClass() == SC_Extern)
        return complain(variable->getLocation(),
                        "the constant '" + name + "' has no value here; give it one");
    type_allowed(variable->getType(), variable->getLocation(), "'" + name + "'");
    if (context_.getTypeSizeInChars(variable->getType()).getQuantity() > 65536)
        complain(variable->getLocation(),
                 "the table '" + name + "' is larger than 64 KiB; make it an array argument");
    types_in(variable->getTypeSourceInfo());
    rename(token_at(variable->getLocation()), name, true);
    initialiser(variable->getInit(), true);
    Site& site = add(SiteKind::FileTable);
    site.range = range_of(variable->getSourceRange());
    site.token = find_token(site.range.first, token_at(variable->getLocation()), "static");
}

void Walk::initialiser(const Expr* value, bool is_constant)
{
    const bool was_constant = in_constant_;
    in_constant_ = in_constant_ || is_constant;
    whole_expression(value);
    in_constant_ = was_constant;
}

Parameter Walk::parameter_of(const ParmVarDecl* declaration)
{
    Parameter parameter;
    parameter.name = own_name(declaration->getName().str());
    parameter.range = range_of(declaration->getSourceRange());
    parameter.name_token = token_at(declaration->getLocation());
    const SourceManager& sources = context_.getSourceManager();
    const SourceLocation at = sources.getExpansionLoc(declaration->getLocation());
    parameter.line = static_cast<int>(sources.getSpellingLineNumber(at));
    parameter.column = static_cast<int>(sources.getSpellingColumnNumber(at));
    const QualType type = declaration->getType();
    const std::string what = "the parameter '" + parameter.name + "'";
    if (!type->isPointerType()) {
        parameter.type = spelled_type(type);
        type_allowed(type, declaration->getLocation(), what);
        return parameter;
    }
    const QualType pointee = type->getPointeeType();
    parameter.type = spelled_type(pointee);
    const auto* record = pointee->getAs<RecordType>();
    if (record && record->getDecl()->getName() == "SurfaceInfo" && !is_users(record->getDecl())) {
        parameter.passing = Passing::Engine;
        return parameter;
    }
    if (const auto* array =
            dyn_cast<ConstantArrayType>(declaration->getOriginalType().getTypePtr()))
        parameter.length = static_cast<long>(array->getSize().getZExtValue());
    if (pointee->isAnyPointerType() || pointee->isArrayType() || pointee->isVoidType() ||
        pointee->isFunctionType())
        complain(declaration->getLocation(),
                 what + " is a pointer to " + (pointee->isVoidType() ? "anything" : "another") +
                     "; pass values, arrays of numbers, or an output parameter such as float* out");
    else
        type_allowed(pointee, declaration->getLocation(), what);
    if (pointee.isConstQualified() && !parameter.type.empty())
        parameter.passing = Passing::View;
    else if (parameter.length)
        parameter.passing = Passing::Array;
    else
        parameter.passing = Passing::Pointer;
    return parameter;
}

void Walk::declare_function(const FunctionDecl* declaration)
{
    const FunctionDecl* canonical = declaration->getCanonicalDecl();
    const SourceLocation at = declaration->getLocation();
    const std::string name = own_name(declaration->getName().str());
    Function function;
    function.name = name;
    function.result = spelled_type(declaration->getReturnType());
    function.returns_void = declaration->getReturnType()->isVoidType();
    function.returns_vector = declaration->getReturnType()->isExtVectorType();
    const SourceManager& sources = context_.getSourceManager();
    const SourceLocation place = sources.getExpansionLoc(at);
    function.line = static_cast<int>(sources.getSpellingLineNumber(place));
    function.column = static_cast<int>(sources.getSpellingColumnNumber(place));
    function.range = range_of(declaration->getSourceRange());
    function.name_token = token_at(at);
    function.open_token = function.name_token + 1;
    function.close_token = matching_close(function.open_token);
    if (function.name_token < 0 || function.close_token < 0 ||
        description_.tokens[function.open_token].text != "(") {
        complain(at, "the function '" + name +
                         "' is declared in an unusual way; write its "
                         "parameters right after its name");
        return;
    }
    if (declaration->doesThisDeclarationHaveABody())
        function.body_end = token_at(declaration->getBody()->getEndLoc());
    function.signature = {function.range.first, function.close_token};
    function.result_text.clear();
    for (int i = function.range.first; i < function.name_token; ++i) {
        const std::string& text = description_.tokens[i].text;
        if (text != "static" && text != "inline" && text != "__inline" && text != "extern")
            function.result_text += text + " ";
    }
    if (declaration->isVariadic())
        complain(at, "'" + name + "' takes any number of arguments; name each of them");
    if (declaration->getReturnType()->isPointerType())
        complain(at, "'" + name + "' returns a pointer; return a value or use an output parameter");
    else if (!function.returns_void)
        type_allowed(declaration->getReturnType(), at, "the result of '" + name + "'");
    if (declaration->doesThisDeclarationHaveABody() && !declaration->hasPrototype() &&
        declaration->getNumParams() > 0)
        complain(at, "'" + name +
                         "' is defined in the style before C89; write the types inside the "
                         "parentheses");
    if (declaration->hasAttr<OpenCLKernelAttr>())
        complain(at, "'" + name + "' is a kernel; a texture is an ordinary function");
    types_in(declaration->getTypeSourceInfo());
    rename(function.name_token, name, true);
    for (const ParmVarDecl* parameter : declaration->parameters()) {
        types_in(parameter->getTypeSourceInfo());
        function.parameters.push_back(parameter_of(parameter));
        if (parameter->getName().empty() && declaration->doesThisDeclarationHaveABody())
            complain(parameter->getLocation(),
                     "a parameter of '" + name + "' has no name; give it one");
        rename(function.parameters.back().name_token, function.parameters.back().name, false);
    }
    const int number = static_cast<int>(description_.functions.size());
    description_.functions.push_back(function);
    if (declaration->doesThisDeclarationHaveABody() || !function_numbers_.count(canonical))
        function_numbers_[canonical] = number;
    for (unsigned i = 0; i < declaration->getNumParams(); ++i)
        parameter_numbers_[declaration->getParamDecl(i)] = {number, static_cast<int>(i)};
}

void Walk::local_variable(const VarDecl* variable, const DeclStmt* statement)
{
    const std::string name = variable->getName().str();
    const SourceLocation at = variable->getLocation();
    types_in(variable->getTypeSourceInfo());
    rename(token_at(at), name, false);
    type_allowed(variable->getType(), at, "'" + name + "'");
    const bool is_const = context_.getBaseElementType(variable->getType()).isConstQualified();
    if (variable->isStaticLocal() || variable->hasExternalStorage()) {
        if (!is_const || !variable->hasInit())
            return complain(at, "'" + name +
                                    "' would keep its value between paths; make it static "
                                    "const with a value, or drop the word static");
        if (!statement->isSingleDecl())
            return complain(at, "several tables in one declaration; declare each by itself");
        initialiser(variable->getInit(), true);
        Site& site = add(SiteKind::StaticTable);
        site.range = range_of(statement->getSourceRange());
        site.token = token_at(at);
        site.number = function_;
        site.text = own_name(name);
        return;
    }
    if (variable->getType()->isIncompleteType()) return;
    const long bytes = context_.getTypeSizeInChars(variable->getType()).getQuantity();
    description_.functions[function_].array_bytes += bytes;
    if (bytes > 16384)
        complain(
            at,
            "'" + name + "' takes " + std::to_string(bytes) +
                " bytes of each path's own "
                "memory, more than 16384; make it smaller, a static const table or an argument");
    const int end = token_at(variable->getEndLoc());
    if (!variable->hasInit()) {
        Site& site = add(SiteKind::ZeroInit);
        site.token = end;
        site.number =
            variable->getType()->isScalarType() || variable->getType()->isExtVectorType() ? 0 : 1;
        site.other = spelled_type(variable->getType()).empty() ? "" : "number";
        return;
    }
    initialised_ = variable;
    initialiser(variable->getInit(), false);
    initialised_ = nullptr;
    watch(variable->getInit());
}

// A value that is kept or returned, where it is one of the user's and of floats.
void Walk::watch(const Expr* value)
{
    const Range range = range_of(value);
    if (range.first > range.last || isa<InitListExpr>(value->IgnoreImplicit())) return;
    const int line = description_.tokens[range.first].line;
    if (spelled_type(value->getType()).rfind("float", 0) != 0 || description_.is_library(line))
        return;
    Site& site = add(SiteKind::Watch);
    site.range = range;
    site.number = description_.place(line).line;
}

}  // namespace texture_tool
