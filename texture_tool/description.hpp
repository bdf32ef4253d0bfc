// What is known of a user's texture once Clang has read it: plain data, all that the tool's later
// parts (check, rewrite, describe) see. Token numbers count the tokens that are left when the
// preprocessor is done; lines (of `source`) and columns count from 1.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace texture_tool {

struct Token {
    int offset = 0;  // in the file; of the macro's name if the token comes from a macro
    int end = 0;     // one past it; past the macro's last parenthesis
    int line = 0;
    int column = 0;
    std::string text;
    bool is_from_macro = false;
};

// A file whose text is part of what is parsed, and the line where it begins there.
struct Section {
    std::string file;
    int line = 1;
};

// First and last token, both inside; first > last: empty.
struct Range {
    int first = 0;
    int last = -1;
};

struct Problem {
    int line = 0;
    int column = 0;
    bool is_error = true;
    std::string text;  // "reason; remedy"
};

// How a parameter reaches a function.
enum class Passing {
    Value,
    View,     // an array that is only read: bounds travel with it
    Pointer,  // one object of the caller's
    Array,    // an array of the caller's with a length that the function declares
    Engine,   // the predecessor's handle, which means nothing here
};

struct Parameter {
    std::string name;
    std::string type;  // of the element for arrays
    Passing passing = Passing::Value;
    std::optional<long> length;  // where declared
    Range range;                 // the whole declaration
    int name_token = -1;
    int line = 0;
    int column = 0;
    bool is_used_as_array = false;
};

struct Call {
    int callee = -1;  // into functions
    int token = -1;   // the name
    long times = 1;   // how often the constant loops around it run it
    int line = 0;
    int column = 0;
};

struct Loop {
    int line = 0;
    int column = 0;
    std::optional<long> trips;  // if known before it runs
    long outer_trips = 1;       // product of the constant loops around it
    Range condition;            // empty if there is none
    int insert_before = -1;     // where a missing condition goes
    bool never_ends = false;    // has neither a condition nor a way out
    bool needs_budget = false;
    bool unrolls = false;
    int token = -1;  // for, while or do
};

struct Function {
    std::string name;
    std::string result;  // "" for structs and void
    std::string result_text;
    int line = 0;
    int column = 0;
    Range range;  // with its body
    Range signature;
    int name_token = -1;
    int open_token = -1;  // of the parameters
    int close_token = -1;
    int body_end = -1;  // its last brace; -1: only declared
    bool returns_always = true;
    bool returns_void = false;
    bool returns_vector = false;
    std::vector<Parameter> parameters;
    std::vector<Call> calls;
    std::vector<Loop> loops;
    long array_bytes = 0;
    long runs = 0;  // for one run of the entry, as far as known
};

struct OcclusionRequest {
    std::string hemisphere;
    bool same_object = false;
    std::optional<double> distance;
    std::string argument;  // the entry's, where the distance is not constant
    int argument_number = -1;
    int function = -1;
    int line = 0;
    int column = 0;
};

enum class SiteKind {
    Name,             // token: a name of the user's; text: what it becomes in OpenCL; other: in C++
    Replace,          // range becomes `text`
    LibraryCall,      // token: its name; text: the function's
    ContextCall,      // the same, with the context as first argument
    UserCall,         // token: name; number: function
    ViewArgument,     // range: an argument; text: the element type; number: length; other: how
    EngineArgument,   // range: an argument that is not passed on
    VectorLiteral,    // token, token2: the parentheses around the type
    CompoundLiteral,  // the same
    Swizzle,          // token: dot, token2: component name; indices; range: what it is of
    SwizzleWrite,     // the same; range2: the value; text: operator (without =)
    VectorChoice,     // range ? range2 : range3 with tokens; text: T, number: width
    Binary,           // range op range2; text: function
    CompoundBinary,   // range op= range2; text: function
    Step,          // ++ or -- : token; range: operand; text: function; number: 1 postfix, 2 unused
    Negate,        // token: minus; range: operand; text: function
    Index,         // token, token2: brackets; number: length
    ViewIndex,     // the same; range: the array; text: element type
    ViewFirst,     // token: star; range: the array; text
    Convert,       // range: operand; text: function; token, token2: an explicit cast's parentheses
    EnumCast,      // range; text: type (C++ only)
    ZeroInit,      // token: where the declarator ends; number: 1 if it needs braces
    ImplicitList,  // range: elements of an aggregate without braces
    StaticTable,   // range: a declaration inside a function; number: function
    FileTable,     // range: a declaration at file scope; token: its `static`, or -1
    Drop,          // token
    EmptyReturn,   // token: return; number: function
    FloatLiteral,  // token
    Watch,         // range: a value of floats that is kept or returned; number: its line
};

struct Site {
    SiteKind kind;
    Range range = {};
    Range range2 = {};
    Range range3 = {};
    int token = -1;
    int token2 = -1;
    long number = 0;
    std::string text = {};
    std::string other = {};
    std::vector<int> indices = {};
    bool only_opencl = false;
};

struct Description {
    std::string file;    // as the user named it
    std::string source;  // the library's functions that are needed, then the user's text
    std::vector<Section> sections;
    int users_line = 1;  // of `source`, where the user's text begins
    std::vector<Token> tokens;
    std::vector<Function> functions;
    std::vector<Site> sites;  // inner before outer
    std::vector<std::string> attributes;
    std::vector<std::string> settings;
    std::vector<OcclusionRequest> occlusion;
    bool reads_images = false;
    std::vector<Problem> problems;
    int entry = -1;

    // The file and its own line for a line of `source`.
    Section place(int line) const
    {
        Section found{file, line};
        for (const Section& section : sections)
            if (section.line <= line) found = {section.file, line - section.line + 1};
        return found;
    }
    bool is_library(int line) const { return line < users_line; }
};

}  // namespace texture_tool
