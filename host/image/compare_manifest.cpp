#include "host/image/compare.hpp"
#include "host/image/whole_file.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <ostream>
#include <stdexcept>

namespace diptych::image {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

[[noreturn]] void fail(const std::string& manifest, const std::string& what)
{
    throw std::runtime_error(manifest + ": " + what);
}

struct Case {
    std::string name;
    CompareOptions options;
};

struct Outcome {
    std::string name;
    std::string failure;  // a limit that was exceeded
    std::string error;    // what kept it from being measured
    std::string json;
    double seconds = 0;
};

std::string text_at(const Json& item, const char* key, const std::string& where)
{
    if (!item.contains(key)) return {};
    if (!item[key].is_string()) fail(where, fmt::format("\"{}\" must be a string", key));
    return item[key].get<std::string>();
}

double number_of(const Json& value, const std::string& key, const std::string& where)
{
    if (!value.is_number()) fail(where, fmt::format("\"{}\" must be a number", key));
    return value.get<double>();
}

std::string beside(const std::string& manifest, const std::string& path)
{
    return path.empty() ? path : (fs::path(manifest).parent_path() / path).string();
}

Case read_case(const Json& item, size_t index, const CompareOptions& common)
{
    const std::string where = fmt::format("{}: comparison {}", common.manifest, index + 1);
    if (!item.is_object())
        fail(where, "must be an object with \"reference\", \"test\" and \"limits\"");
    for (const auto& [key, value] : item.items()) {
        static const char* const known[] = {"name",  "reference", "test",    "limits",
                                            "layer", "ppd",       "heat_map"};
        if (std::find(std::begin(known), std::end(known), key) == std::end(known))
            fail(where, fmt::format("unknown key \"{}\"; there are name, reference, test, limits, "
                                    "layer, ppd, heat_map",
                                    key));
    }
    Case result;
    CompareOptions& options = result.options;
    options.reference = beside(common.manifest, text_at(item, "reference", where));
    options.test = beside(common.manifest, text_at(item, "test", where));
    options.heat_map = beside(common.manifest, text_at(item, "heat_map", where));
    options.layer = text_at(item, "layer", where);
    options.pixels_per_degree = common.pixels_per_degree;
    if (item.contains("ppd")) options.pixels_per_degree = number_of(item["ppd"], "ppd", where);
    const Json limits = item.value("limits", Json::object());
    if (!limits.is_object()) fail(where, "\"limits\" must be an object of metric: maximum");
    for (const auto& [metric, limit] : limits.items()) {
        options.metrics.push_back(metric);
        options.limits.push_back(number_of(limit, metric, where));
    }
    result.name = text_at(item, "name", where);
    if (result.name.empty()) result.name = text_at(item, "test", where);
    return result;
}

Json read_list(const std::string& manifest)
{
    std::error_code ignored;
    if (fs::is_directory(manifest, ignored)) fail(manifest, "is a folder; name a JSON file");
    std::ifstream file(manifest);
    if (!file) fail(manifest, "cannot be opened; check the path");
    Json list;
    try {
        list = Json::parse(file);
    } catch (const Json::parse_error& error) {
        std::string reason = error.what();
        std::replace(reason.begin(), reason.end(), '\n', ' ');
        fail(manifest, "is not JSON (" + reason + "); see diptych compare --help for its form");
    }
    if (!list.is_array())
        fail(manifest,
             "is not a JSON list of comparisons; see diptych compare --help for its form");
    if (list.empty()) fail(manifest, "holds no comparison; add some");
    return list;
}

std::vector<Case> read_cases(const CompareOptions& options)
{
    if (!options.reference.empty() || !options.metrics.empty() || !options.limits.empty() ||
        !options.layer.empty() || !options.heat_map.empty())
        fail("--manifest " + options.manifest,
             "says what to compare and how: leave out A, B, --metric, --max, --layer and -o");
    const Json list = read_list(options.manifest);
    std::vector<Case> cases;
    for (size_t k = 0; k < list.size(); ++k) cases.push_back(read_case(list[k], k, options));
    return cases;
}

Outcome run(const Case& one)
{
    const auto start = std::chrono::steady_clock::now();
    Outcome outcome{one.name, {}, {}, {}, 0};
    try {
        const CompareResult result = compare_pictures(one.options);
        outcome.json = result.json;
        for (const Measurement& m : result.measurements)
            if (!m.within)
                outcome.failure +=
                    fmt::format("{}{} is {:.6g}, above {:.6g}", outcome.failure.empty() ? "" : "; ",
                                m.metric, m.value, m.limit);
    } catch (const std::exception& error) {
        outcome.error = error.what();
    }
    outcome.seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return outcome;
}

// For an attribute's value; control characters have no place in XML 1.0.
std::string xml_text(const std::string& text)
{
    std::string out;
    for (const char c : text) {
        if (c == '&')
            out += "&amp;";
        else if (c == '<')
            out += "&lt;";
        else if (c == '>')
            out += "&gt;";
        else if (c == '"')
            out += "&quot;";
        else
            out += static_cast<unsigned char>(c) < ' ' ? ' ' : c;
    }
    return out;
}

std::string junit_xml(const std::string& manifest, const std::vector<Outcome>& outcomes)
{
    size_t failures = 0, errors = 0;
    double seconds = 0;
    std::string cases;
    const std::string suite = xml_text(fs::path(manifest).stem().string());
    for (const Outcome& outcome : outcomes) {
        failures += !outcome.failure.empty();
        errors += !outcome.error.empty();
        seconds += outcome.seconds;
        const std::string head =
            fmt::format("    <testcase classname=\"{}\" name=\"{}\" time=\"{:.3f}\"", suite,
                        xml_text(outcome.name), outcome.seconds);
        if (!outcome.error.empty())
            cases += fmt::format("{}>\n      <error message=\"{}\"/>\n    </testcase>\n", head,
                                 xml_text(outcome.error));
        else if (!outcome.failure.empty())
            cases += fmt::format("{}>\n      <failure message=\"{}\"/>\n    </testcase>\n", head,
                                 xml_text(outcome.failure));
        else
            cases += head + "/>\n";
    }
    const std::string counts =
        fmt::format("tests=\"{}\" failures=\"{}\" errors=\"{}\" time=\"{:.3f}\"", outcomes.size(),
                    failures, errors, seconds);
    return fmt::format("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites {0}>\n  <testsuite "
                       "name=\"{1}\" {0}>\n"
                       "{2}  </testsuite>\n</testsuites>\n",
                       counts, suite, cases);
}

std::string json_list(const std::vector<Outcome>& outcomes)
{
    Json list = Json::array();
    for (const Outcome& outcome : outcomes) {
        Json item =
            outcome.json.empty() ? Json{{"error", outcome.error}} : Json::parse(outcome.json);
        item["name"] = outcome.name;
        list.push_back(item);
    }
    return list.dump(1) + "\n";
}

// The XML and the JSON where they were asked for; the lines a person reads unless standard output
// is taken.
void report(const CompareOptions& options, const std::vector<Outcome>& outcomes, std::ostream& out)
{
    const std::string xml = junit_xml(options.manifest, outcomes);
    if (!options.junit.empty()) write_text(options.junit, xml);
    if (options.json && !options.json_file.empty())
        write_text(options.json_file, json_list(outcomes));
    if (options.json && options.json_file.empty())
        out << json_list(outcomes);
    else if (options.junit.empty())
        out << xml;
    else
        for (const Outcome& outcome : outcomes)
            out << fmt::format("{:<7} {}{}\n",
                               !outcome.error.empty()     ? "error"
                               : !outcome.failure.empty() ? "ABOVE"
                                                          : "within",
                               outcome.name, outcome.failure.empty() ? "" : ": " + outcome.failure);
}

}  // namespace

int compare_manifest(const CompareOptions& options, std::ostream& out, std::ostream& err)
{
    try {
        std::vector<Outcome> outcomes;
        for (const Case& one : read_cases(options)) outcomes.push_back(run(one));
        report(options, outcomes, out);
        int code = 0;
        for (const Outcome& outcome : outcomes) {
            if (!outcome.error.empty())
                err << "diptych: " << outcome.name << ": " << outcome.error << '\n';
            code = std::max(code, !outcome.error.empty() ? 2 : !outcome.failure.empty() ? 1 : 0);
        }
        return code;
    } catch (const std::exception& error) {
        err << "diptych: " << error.what() << '\n';
        return 2;
    }
}

}  // namespace diptych::image
