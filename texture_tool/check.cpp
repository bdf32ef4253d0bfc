#include "texture_tool/check.hpp"

#include <algorithm>
#include <set>

namespace texture_tool {

namespace {

// Loops whose constant nest runs this often, in all for one evaluation, go without a budget.
constexpr long free_iterations = 65536;
// Loops that run this often are unrolled on the CPU: g++ vectorises no loop that holds another.
constexpr long most_unrolled = 64;
constexpr long most_copies = 512;
// Every call is inlined: so many words may be left in all. A function of the language counts as so
// many of them; compilers take about as long for it.
constexpr long most_words = 100000;
constexpr long words_of_library_call = 40;
constexpr long most_bytes = 65536;

void complain(Description& description, int line, int column, const std::string& text)
{
    description.problems.push_back({line, column, true, text});
}

// Calls go to definitions; a declaration stands for the definition of its name.
int definition_of(const Description& description, int number)
{
    const Function& function = description.functions[number];
    if (function.body_end >= 0) return number;
    for (size_t i = 0; i < description.functions.size(); ++i)
        if (description.functions[i].body_end >= 0 &&
            description.functions[i].name == function.name)
            return static_cast<int>(i);
    return -1;
}

class CallGraph {
public:
    explicit CallGraph(Description& description)
        : description_(description), state_(description.functions.size(), 0),
          words_(description.functions.size(), 0)
    {
        for (size_t i = 0; i < words_.size(); ++i) {
            const Range& range = description.functions[i].range;
            words_[i] = range.last - range.first;
            for (const Site& site : description.sites)
                if (site.kind == SiteKind::LibraryCall && site.token >= range.first &&
                    site.token <= range.last)
                    words_[i] += words_of_library_call;
        }
    }

    // Recursion, and calls of what is nowhere defined.
    void check()
    {
        for (size_t i = 0; i < state_.size(); ++i) visit(static_cast<int>(i));
    }

    // Words of the function with all that it calls in place of the calls; the functions' runs grow
    // by `times`. Only without recursion.
    long spread(int number, long times)
    {
        Function& function = description_.functions[number];
        function.runs = std::min(function.runs + times, 1L << 40);
        long words = words_[number];
        for (const Call& call : function.calls) {
            const int callee = definition_of(description_, call.callee);
            if (callee < 0) continue;
            words += spread(callee, std::min(times * call.times, 1L << 40));
            if (words > most_words) break;
        }
        return words;
    }

    long bytes(int number) const
    {
        const Function& function = description_.functions[number];
        long deepest = 0;
        for (const Call& call : function.calls) {
            const int callee = definition_of(description_, call.callee);
            if (callee >= 0) deepest = std::max(deepest, bytes(callee));
        }
        return function.array_bytes + deepest;
    }

private:
    void visit(int number)
    {
        if (state_[number] == 2) return;
        state_[number] = 1;
        path_.push_back(number);
        for (const Call& call : description_.functions[number].calls) {
            const int callee = definition_of(description_, call.callee);
            if (callee < 0)
                complain(description_, call.line, call.column,
                         "'" + description_.functions[call.callee].name +
                             "' is declared but nowhere defined; define it in this file");
            else if (state_[callee] == 1)
                complain(description_, call.line, call.column, recursion(callee));
            else
                visit(callee);
        }
        path_.pop_back();
        state_[number] = 2;
    }

    std::string recursion(int callee) const
    {
        std::string names;
        for (auto at = std::find(path_.begin(), path_.end(), callee); at != path_.end(); ++at)
            names += description_.functions[*at].name + " calls ";
        return "recursion: " + names + description_.functions[callee].name +
               "; GPUs have no call stack, use a loop";
    }

    Description& description_;
    std::vector<int> state_;  // 0 new, 1 on the path, 2 done
    std::vector<int> path_;
    std::vector<long> words_;  // of each alone
};

void choose_entry(Description& description, const std::string& wanted)
{
    std::set<std::string> called;
    std::vector<int> defined;
    for (size_t i = 0; i < description.functions.size(); ++i) {
        if (description.functions[i].body_end >= 0 &&
            !description.is_library(description.functions[i].line))
            defined.push_back(static_cast<int>(i));
        for (const Call& call : description.functions[i].calls)
            called.insert(description.functions[call.callee].name);
    }
    std::vector<int> candidates;
    std::string names;
    for (const int number : defined) {
        const std::string& name = description.functions[number].name;
        if (!wanted.empty() && name == wanted) {
            description.entry = number;
            return;
        }
        if (wanted.empty() && called.count(name)) continue;
        candidates.push_back(number);
        names += (names.empty() ? "" : ", ") + name;
    }
    if (defined.empty())
        return complain(description, description.users_line, 1,
                        "the file defines no function; a texture is a function that "
                        "returns a colour");
    if (!wanted.empty())
        return complain(description, description.users_line, 1,
                        "no function '" + wanted + "' here; the file defines: " + names);
    for (const char* usual : {"main", "userProc"})
        for (const int number : candidates)
            if (candidates.size() > 1 && description.functions[number].name == usual) {
                description.entry = number;
                return;
            }
    if (candidates.size() == 1)
        description.entry = candidates[0];
    else
        complain(description, description.users_line, 1,
                 candidates.empty()
                     ? "every function is called by another, none can be the texture; name one"
                     : "several functions could be the texture: " + names + "; name one of them");
}

bool is_argument_type(const std::string& type)
{
    static const std::set<std::string> types = {"int",    "int2",   "int3",  "int4",  "uint",
                                                "uint2",  "uint3",  "uint4", "float", "float2",
                                                "float3", "float4", "sam2D"};
    return types.count(type) > 0;
}

void check_entry(Description& description)
{
    const Function& entry = description.functions[description.entry];
    if (entry.result != "float" && entry.result != "float2" && entry.result != "float3" &&
        entry.result != "float4")
        complain(description, entry.line, entry.column,
                 "the texture '" + entry.name +
                     "' returns no colour; let it return float, float2, float3 or float4");
    for (const Parameter& parameter : entry.parameters) {
        const bool is_given =
            parameter.passing == Passing::Value || parameter.passing == Passing::View;
        if (parameter.passing == Passing::Pointer || parameter.passing == Passing::Array)
            complain(description, parameter.line, parameter.column,
                     "the texture's parameter '" + parameter.name +
                         "' could be written; a scene's "
                         "arrays are const: const float* name");
        else if (is_given && !is_argument_type(parameter.type))
            complain(description, parameter.line, parameter.column,
                     "a scene cannot give the texture's parameter '" + parameter.name +
                         "'; arguments "
                         "are int, uint and float, their vectors of 2, 3 and 4, sam2D, and const "
                         "arrays of "
                         "these");
    }
    for (OcclusionRequest& request : description.occlusion) {
        if (request.argument.empty()) continue;
        int number = 0;
        for (const Parameter& parameter : entry.parameters) {
            if (parameter.name == request.argument && request.function == description.entry)
                request.argument_number = number;
            number += parameter.passing == Passing::Engine ? 0 : 1;
        }
        if (request.argument_number < 0)
            complain(description, request.line, request.column,
                     "the distance must be known before the texture runs; ask in '" + entry.name +
                         "' itself and hand the result on");
    }
}

}  // namespace

bool has_errors(const Description& description)
{
    return std::any_of(description.problems.begin(), description.problems.end(),
                       [](const Problem& problem) { return problem.is_error; });
}

void check(Description& description, const std::string& wanted)
{
    if (has_errors(description)) return;
    CallGraph graph(description);
    graph.check();
    for (const Function& function : description.functions)
        for (const Loop& loop : function.loops)
            if (loop.never_ends)
                complain(description, loop.line, loop.column,
                         "this loop never ends; give it a condition, a break or a return");
    if (has_errors(description)) return;
    choose_entry(description, wanted);
    if (description.entry < 0) return;
    check_entry(description);
    const Function& entry = description.functions[description.entry];
    if (const long words = graph.spread(description.entry, 1); words > most_words)
        complain(description, entry.line, entry.column,
                 "'" + entry.name + "' with all that it calls is longer than " +
                     std::to_string(most_words) +
                     " words; every call is copied into the kernel, use loops");
    else if (const long bytes = graph.bytes(description.entry); bytes > most_bytes)
        complain(description, entry.line, entry.column,
                 "the variables of '" + entry.name + "' and what it calls take " +
                     std::to_string(bytes) + " bytes for each path, more than " +
                     std::to_string(most_bytes) + "; use fewer");
    for (Function& function : description.functions)
        for (Loop& loop : function.loops) {
            const double iterations = static_cast<double>(loop.trips.value_or(0)) *
                                      static_cast<double>(loop.outer_trips) *
                                      static_cast<double>(std::max(function.runs, 1L));
            loop.needs_budget = !loop.trips || iterations > static_cast<double>(free_iterations);
            loop.unrolls = !loop.needs_budget && *loop.trips <= most_unrolled &&
                           iterations <= static_cast<double>(most_copies);
        }
}

}  // namespace texture_tool
