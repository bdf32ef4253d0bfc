#include "backends/kernel_sources.hpp"

namespace diptych {

#define DECLARE_LINES(name, body, when, needs) extern const char* const name##_lines[];
STAGES(DECLARE_LINES)

namespace {

struct Row {
    When when;
    unsigned needs;
    const char* const* lines;
};

#define STAGE_ROW(name, body, when, needs) {When::when, unsigned(needs), name##_lines},
const Row rows[] = {STAGES(STAGE_ROW)};

}  // namespace

std::string kernel_source(Stage stage)
{
    std::string source;
    for (const char* const* line = rows[stage].lines; *line; ++line) source += *line;
    return source;
}

When stage_when(Stage stage) { return rows[stage].when; }

unsigned stage_needs(Stage stage) { return rows[stage].needs; }

}  // namespace diptych
