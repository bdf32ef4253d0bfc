#include "texture_tool/rewrite.hpp"

#include <algorithm>
#include <optional>
#include <set>

#include "texture_tool/language.hpp"
#include "texture_tool/render.hpp"

namespace texture_tool {

namespace {

const char* const context = "tx_context";

// Before the user's text, in its namespace: notes the line of a value that is not finite.
const char* const watch_text =
    "inline int tx_is_finite(float v) { return math_abs(v) <= FLOAT_MAX; }\n"
    "inline int tx_is_finite(float2 v) { return tx_is_finite(v.x) & tx_is_finite(v.y); }\n"
    "inline int tx_is_finite(float3 v)\n"
    "{ return tx_is_finite(v.x) & tx_is_finite(v.y) & tx_is_finite(v.z); }\n"
    "inline int tx_is_finite(float4 v)\n"
    "{ return tx_is_finite(v.x) & tx_is_finite(v.y) & tx_is_finite(v.z) & tx_is_finite(v.w); }\n"
    "template<typename T> T tx_watch(TextureContext* tx, int line, T v)\n"
    "{\n"
    "    if constexpr (requires { tx_is_finite(v); }) {\n"
    "        if (!tx_is_finite(v) && tx->fault_line == 0) tx->fault_line = line;\n"
    "    }\n"
    "    return v;\n"
    "}\n";

// Likewise, of an index that is out of range. An array's own access counts those.
const char* const watch_index_text =
    "inline void tx_note_index(TextureContext* tx, int line, int clamped_before)\n"
    "{\n"
    "    if (clamped_before == 0 && tx->clamped != 0) tx->fault_line = line;\n"
    "}\n"
    "inline int tx_watched_index(TextureContext* tx, int line, int i, int n)\n"
    "{\n"
    "    const int before = tx->clamped, inside = tx_index(tx, i, n);\n"
    "    tx_note_index(tx, line, before);\n"
    "    return inside;\n"
    "}\n"
    "template<typename At, typename View>\n"
    "auto tx_watched_at(TextureContext* tx, int line, At at, View v, int i)\n"
    "{\n"
    "    const int before = tx->clamped;\n"
    "    const auto element = at(tx, v, i);\n"
    "    tx_note_index(tx, line, before);\n"
    "    return element;\n"
    "}\n";

class Rewriter {
public:
    Rewriter(const Description& description, Variant variant, const std::string& id)
        : description_(description), is_cpp_(variant != Variant::OpenCl), variant_(variant),
          id_(id), text_(description), hoisted_(description.functions.size())
    {
    }

    Rewritten run()
    {
        for (const Site& site : description_.sites)
            if (!site.only_opencl || !is_cpp_) apply(site);
        for (const Function& function : description_.functions) budget(function);
        for (size_t i = 0; i < description_.functions.size(); ++i) signature(i);
        drop_words();
        for (const Function& function : description_.functions)
            if (description_.is_library(function.line) && function.runs == 0)
                text_.remove(function.range);
        Rewritten result;
        if (is_cpp_) result.text = "namespace " + id_ + " {\n";
        if (variant_ == Variant::WatchedValues) result.text += watch_text;
        if (variant_ == Variant::WatchedIndexes) result.text += watch_index_text;
        result.text +=
            with_line_marks(text_.file()) + "\n#line 1 \"<generated: " + id_ + ">\"\n" + entry();
        if (is_cpp_) result.text += "}  // namespace " + id_ + "\n";
        result.changed_lines = text_.count_changed_lines();
        result.total_lines = static_cast<int>(std::count(description_.source.begin(),
                                                         description_.source.end(), '\n')) -
                             description_.users_line + 1;
        return result;
    }

private:
    void apply(const Site& site)
    {
        switch (site.kind) {
        case SiteKind::Name:
            return name(site);
        case SiteKind::Replace:
            text_.remove(site.range);
            return text_.replace(site.range.first, site.text);
        case SiteKind::LibraryCall:
            return text_.replace(site.token, site.text);
        case SiteKind::ContextCall:
            text_.replace(site.token, site.text);
            return text_.after(site.token + 1, std::string(context) + ", ");
        case SiteKind::UserCall:
            return text_.after(site.token + 1,
                               std::string(context) + (site.other.empty() ? "" : ", "));
        case SiteKind::ViewArgument:
            text_.before(site.range.first, "tx_view_of_" + site.other + "_" + site.text + "(");
            return text_.after(site.range.last, ", " + std::to_string(site.number) + ")");
        case SiteKind::VectorLiteral:
        case SiteKind::CompoundLiteral:
            if (!is_cpp_) return;
            text_.replace(site.token, "");
            for (int i = site.token + 1; i < site.token2; ++i)  // C++ would read a declaration
                for (const char* word : {"const", "struct", "union", "enum"})
                    if (description_.tokens[i].text == word) text_.replace(i, "");
            return text_.replace(site.token2, "");
        case SiteKind::Swizzle:
            return swizzle(site);
        case SiteKind::SwizzleWrite:
            return swizzle_write(site);
        case SiteKind::VectorChoice:
            return choice(site);
        case SiteKind::Binary:
            text_.before(site.range.first, site.text + "(");
            text_.replace(site.token, ",");
            return text_.after(site.range2.last, ")");
        case SiteKind::CompoundBinary:
            return compound(site);
        case SiteKind::Step:
            return step(site);
        case SiteKind::Negate:
            text_.replace(site.token, site.text + "(");
            return text_.after(site.range.last, ")");
        case SiteKind::Index:
            return index(site);
        case SiteKind::ViewIndex:
            text_.before(site.range.first, element_of(site));
            text_.replace(site.token, ", ");
            return text_.replace(site.token2, ")");
        case SiteKind::ViewFirst:
            text_.replace(site.token, element_of(site));
            return text_.after(site.range.last, ", 0)");
        case SiteKind::Convert:
            return convert(site);
        case SiteKind::EnumCast:
            if (!is_cpp_) return;
            text_.before(site.range.first, "(" + site.text + ")(");
            return text_.after(site.range.last, ")");
        case SiteKind::ZeroInit:
            return text_.after(site.token, is_cpp_ ? " = {}" : (site.number ? " = {0}" : " = 0"));
        case SiteKind::ImplicitList:
            text_.before(site.range.first, "{");
            return text_.after(site.range.last, "}");
        case SiteKind::StaticTable:
            return static_table(site);
        case SiteKind::FileTable:
            if (is_cpp_) return;
            if (site.token >= 0) return text_.replace(site.token, "__constant");
            return text_.before(site.range.first, "__constant ");
        case SiteKind::EmptyReturn:
            return text_.replace(site.token, "return " + zero(description_.functions[site.number]));
        case SiteKind::FloatLiteral:
            return float_literal(site);
        case SiteKind::Watch:
            if (variant_ != Variant::WatchedValues) return;
            text_.before(site.range.first, "tx_watch(" + std::string(context) + ", " +
                                               std::to_string(site.number) + ", (");
            return text_.after(site.range.last, "))");
        case SiteKind::EngineArgument:
        case SiteKind::Drop:
            return;
        }
    }

    void name(const Site& site)
    {
        std::string name = site.text;
        if (is_cpp_ || site.number == 0) {
            if (needs_other_name(name)) name += "_";
        } else if (site.number == 1) {
            name = id_ + "_" + name;
        } else {
            name = hoisted_name(name, site.range.first);
        }
        text_.replace(site.token, name);
    }

    std::string hoisted_name(const std::string& name, int token) const
    {
        return id_ + "_" + name + "_" + std::to_string(token);
    }

    void swizzle(const Site& site)
    {
        static const char* const letters = "xyzw";
        if (site.indices.size() == 1) {
            const int i = site.indices[0];
            const std::string own = site.number <= 4 ? std::string(1, letters[i])
                                                     : "s" + std::string(1, "0123456789abcdef"[i]);
            return text_.replace(site.token2, own);
        }
        if (is_cpp_) text_.replace(site.token2, "get<" + list(site.indices) + ">()");
    }

    static std::string list(const std::vector<int>& numbers)
    {
        std::string text;
        for (const int number : numbers)
            text += (text.empty() ? "" : ", ") + std::to_string(number);
        return text;
    }

    void swizzle_write(const Site& site)
    {
        if (!is_cpp_) return;
        const std::string base = text_.range(site.range);
        std::string value = "(";
        if (!site.text.empty())
            value = "(" + base + ".get<" + list(site.indices) + ">() " + site.text + " (";
        text_.replace(site.token2, "set<" + list(site.indices) + ">");
        text_.replace(std::stoi(site.other), value);
        text_.after(site.range2.last, site.text.empty() ? ")" : "))");
    }

    void choice(const Site& site)
    {
        if (!is_cpp_) return;
        if (site.other.empty()) {
            // C++ wants both sides alike; a scalar beside a vector widens.
            text_.before(site.range2.first, site.text + "(");
            text_.after(site.range2.last, ")");
            text_.before(site.range3.first, site.text + "(");
            return text_.after(site.range3.last, ")");
        }
        const std::string element = site.text.substr(0, site.text.find_first_of("0123456789"));
        text_.before(site.range.first,
                     "tx_choose<" + element + ", " + std::to_string(site.number) + ">(");
        text_.replace(site.token, ",");
        text_.replace(site.token2, ",");
        text_.after(site.range3.last, ")");
    }

    void compound(const Site& site)
    {
        if (is_cpp_ && site.text.rfind("tx_", 0) == 0 && site.other.empty() &&
            is_wrapping(site.text))
            return;
        const std::string left = text_.range(site.range);
        const std::string written = description_.tokens[site.token].text;
        const std::string operation = written.substr(0, written.size() - 1);
        std::string start = "= ";
        std::string end;
        if (!site.other.empty()) {
            start += site.other + "(" + left + " " + operation + " (";
            end = "))";
        } else {
            start += site.text + "(" + left + ", ";
            end = ")";
        }
        if (site.number) text_.before(site.range.first, "(");
        text_.replace(site.token, start);
        text_.after(site.range2.last, end + (site.number ? ")" : ""));
    }

    static bool is_wrapping(const std::string& function)
    {
        return function.find("_add_") != std::string::npos ||
               function.find("_subtract_") != std::string::npos ||
               function.find("_multiply_") != std::string::npos;
    }

    void step(const Site& site)
    {
        const std::string operand = text_.range(site.range);
        const std::string add = "tx_" + site.other + "_" + site.text;
        const std::string back =
            "tx_" + std::string(site.other == "add" ? "subtract" : "add") + "_" + site.text;
        text_.replace(site.token, "");
        std::string assigned = operand + " = " + add + "(" + operand + ", 1)";
        if (site.number == 0) assigned = "(" + assigned + ")";
        if (site.number == 1) assigned = back + "(" + assigned + ", 1)";
        text_.remove(site.range);
        text_.replace(site.range.first, assigned);
    }

    // Where an access of the user's own is to be noted.
    std::optional<std::string> watched_line(const Site& site) const
    {
        const int line = description_.tokens[site.token].line;
        if (variant_ != Variant::WatchedIndexes || description_.is_library(line)) return {};
        return std::to_string(description_.place(line).line);
    }

    // The call that gives an array's element, as far as the array.
    std::string element_of(const Site& site) const
    {
        const std::string at = "tx_at_" + site.text, tx = context;
        const std::optional<std::string> line = watched_line(site);
        return line ? "tx_watched_at(" + tx + ", " + *line + ", " + at + ", "
                    : at + "(" + tx + ", ";
    }

    void index(const Site& site)
    {
        if (!site.text.empty()) {
            // A component chosen by a number.
            const std::string base = text_.range(site.range);
            text_.remove(site.range);
            text_.replace(site.range.first, "((" + site.text + "*)&" + base + ")");
        }
        const std::optional<std::string> line = watched_line(site);
        text_.after(site.token, (line ? "tx_watched_index(" : "tx_index(") + std::string(context) +
                                    ", " + (line ? *line + ", " : ""));
        text_.before(site.token2, ", " + std::to_string(site.number) + ")");
    }

    void convert(const Site& site)
    {
        const std::string cast = site.other.empty() ? "" : "(" + site.other + ")";
        if (site.token >= 0) {
            int close = site.token;
            while (description_.tokens[close].text != ")") ++close;
            text_.remove({site.token, close});
        }
        text_.before(site.range.first, cast + site.text + "(");
        text_.after(site.range.last, ")");
    }

    // Function-local tables stand before the function in OpenCL, whose functions hold no constants.
    void static_table(const Site& site)
    {
        if (is_cpp_) return name_of_local_table(site);
        text_.replace(site.token, hoisted_name(site.text, site.token));
        for (int i = site.range.first; i < site.token; ++i)
            if (description_.tokens[i].text == "static") text_.replace(i, "__constant");
        hoisted_[site.number] += text_.range(site.range) + " ";
        text_.remove(site.range);
    }

    void name_of_local_table(const Site& site)
    {
        if (needs_other_name(site.text)) text_.replace(site.token, site.text + "_");
    }

    void float_literal(const Site& site)
    {
        const std::string& number = description_.tokens[site.token].text;
        const char last = number.back();
        const bool is_hex = number.size() > 1 && (number[1] == 'x' || number[1] == 'X');
        const bool has_suffix =
            is_hex ? (last == 'f' || last == 'F') && number.find_first_of("pP") != std::string::npos
                   : last == 'f' || last == 'F';
        if (!has_suffix && number.find_first_of("0123456789") != std::string::npos)
            text_.after(site.token, "f");
    }

    std::string zero(const Function& function) const
    {
        if (is_cpp_) return "{}";
        if (!function.result.empty() && function.result != "sam2D")
            return function.returns_vector ? "(" + function.result + ")(0)" : "0";
        return "(" + opencl_result(function) + "){0}";
    }

    std::string opencl_result(const Function& function) const
    {
        std::string text;
        for (int i = function.range.first; i < function.name_token; ++i) {
            const std::string& word = description_.tokens[i].text;
            if (word != "static" && word != "inline" && word != "const")
                text += text_.token(i) + " ";
        }
        return text;
    }

    void budget(const Function& function)
    {
        for (const Loop& loop : function.loops) {
            if (is_cpp_ && loop.unrolls && *loop.trips > 0)
                text_.before(loop.token,
                             "_Pragma(\"GCC unroll " + std::to_string(*loop.trips) + "\") ");
            if (!loop.needs_budget) continue;
            const std::string spend = "tx_spend(" + std::string(context) + ", " +
                                      std::to_string(description_.place(loop.line).line) + ")";
            if (loop.condition.last < 0) {
                text_.before(loop.insert_before, spend);
                continue;
            }
            text_.before(loop.condition.first, "(");
            text_.after(loop.condition.last, ") && " + spend);
        }
    }

    std::string parameter_text(const Parameter& parameter) const
    {
        std::string text;
        if (parameter.passing == Passing::View)
            return "tx_view_" + parameter.type + " " +
                   (parameter.name_token < 0 ? "" : text_.token(parameter.name_token));
        if (parameter.passing == Passing::Engine)
            return "const SurfaceInfo* " +
                   (parameter.name_token < 0 ? "" : text_.token(parameter.name_token));
        for (int i = parameter.range.first; i <= parameter.range.last; ++i) {
            const std::string& word = description_.tokens[i].text;
            if (word == "register" || word == "restrict" || word == "__restrict") continue;
            text += (text.empty() ? "" : " ") + text_.token(i);
        }
        return text;
    }

    // The parameters once more, with the context before them; on the line where they begin.
    void signature(size_t number)
    {
        const Function& function = description_.functions[number];
        std::string parameters = "TextureContext* " + std::string(context);
        for (const Parameter& parameter : function.parameters)
            parameters += ", " + parameter_text(parameter);
        if (function.close_token > function.open_token + 1)
            text_.remove({function.open_token + 1, function.close_token - 1});
        text_.after(function.open_token, parameters);
        for (int i = function.range.first; i < function.name_token; ++i) {
            const std::string& word = description_.tokens[i].text;
            if (word == "static" || word == "inline" || word == "__inline" || word == "extern")
                text_.replace(i, "");
        }
        text_.before(function.range.first, hoisted_[number] + "SHARED ");
        if (function.body_end >= 0 && !function.returns_always)
            text_.before(function.body_end, "return " + zero(function) + "; ");
    }

    void drop_words()
    {
        for (size_t i = 0; i < description_.tokens.size(); ++i) {
            const std::string& word = description_.tokens[i].text;
            if (word == "register" || word == "restrict" || word == "__restrict")
                text_.replace(static_cast<int>(i), "");
        }
    }

    // Says before each file's text which file it is.
    std::string with_line_marks(const std::string& text) const
    {
        std::string marked;
        size_t at = 0;
        int line = 1;
        for (const Section& section : description_.sections) {
            const size_t start = at;
            for (; line < section.line && at < text.size(); ++line) at = text.find('\n', at) + 1;
            marked += text.substr(start, at - start);
            marked += "#line 1 \"" + quoted(section.file) + "\"\n";
        }
        return marked + text.substr(at);
    }

    std::string entry() const
    {
        const Function& function = description_.functions[description_.entry];
        std::string text =
            "SHARED float4 " + id_ + "_entry(TextureContext* " + context + ", int region)\n{\n";
        std::string arguments = context;
        int k = 0;
        for (const Parameter& parameter : function.parameters) {
            if (parameter.passing == Passing::Engine) {
                arguments += ", (const SurfaceInfo*)0";
                continue;
            }
            const bool is_array = parameter.passing == Passing::View;
            arguments += std::string(",\n        ") +
                         (is_array ? "tx_argument_view_" : "tx_argument_") + parameter.type + "(" +
                         context + ", region, " + std::to_string(k++) + ")";
        }
        text += "    return tx_result_of_" + function.result + "(" +
                text_.token(function.name_token) + "(" + arguments + "));\n}\n";
        return text;
    }

    // A file name as #line takes it: nothing in it ends the line or the text.
    static std::string quoted(const std::string& name)
    {
        std::string text;
        for (const char c : name) {
            if (c == '"' || c == '\\') text += '\\';
            text += static_cast<unsigned char>(c) < 32 ? '_' : c;
        }
        return text;
    }

    const Description& description_;
    bool is_cpp_;
    Variant variant_;
    std::string id_;
    TokenText text_;
    std::vector<std::string> hoisted_;
};

}  // namespace

Rewritten rewrite(const Description& description, Variant variant, const std::string& id)
{
    return Rewriter(description, variant, id).run();
}

}  // namespace texture_tool
