// How far an adaptive render says that it has come, against how far it had.
#include "host/render/forecast.hpp"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

namespace {

using namespace diptych;

// What was said at a decision, and how many quanta there were.
struct Statement {
    double fraction;
    int quanta;
};

int quanta_of_all(const Schedule& schedule)
{
    int sum = 0;
    for (const BlockState& block : schedule.blocks) sum += block.quanta;
    return sum;
}

// Renders 64 blocks, whose errors fall as this power of their quanta from 1 to 5 JND, to 1 JND; a
// few begin far above all others.
std::vector<Statement> statements(double exponent, int teams, double share = 1)
{
    Targets targets;
    targets.share = share;
    const BlockGrid grid = grid_of_blocks(8 * 16, 8 * 16);
    const std::vector<Quantum> plan = quanta_of(1 << 20);
    Schedule schedule{.blocks = std::vector<BlockState>(grid.corners.size())};
    schedule.teams = teams;
    Forecast forecast;
    std::vector<Statement> said;
    for (int idle = 0; idle < teams;) {
        for_team(schedule, schedule.turn, [&](size_t b) {
            BlockState& block = schedule.blocks[b];
            block.quanta = block.target;
            if (block.is_done || block.quanta == 0) return;
            const double first = b % 16 == 3 ? 10 : 1 + double(b) / 16;  // JND at four quanta
            const double jnd = first * std::pow(block.quanta / 4.0, -exponent);
            block.error = {int(jnd * error_unit), 0};
        });
        forecast.observe(schedule);
        idle = begin_adaptive_round(schedule, grid, plan, targets) ? 0 : idle + 1;
        said.push_back({forecast.fraction(schedule, error_unit, int(plan.size()), share),
                        quanta_of_all(schedule)});
    }
    return said;
}

class ForecastOf : public testing::TestWithParam<double> {};

void expect_true(const std::vector<Statement>& said)
{
    const double all = said.back().quanta;
    int checked = 0;
    for (const Statement& s : said) {
        if (s.quanta < 64 * 16) continue;  // each block has been measured twice
        ++checked;
        EXPECT_GT(s.fraction, 0.75 * s.quanta / all) << s.quanta;
        EXPECT_LT(s.fraction, 1.35 * s.quanta / all) << s.quanta;
    }
    EXPECT_GT(checked, 3);
}

TEST_P(ForecastOf, FractionsComeTrue)
{
    for (const int teams : {1, 2}) {
        const std::vector<Statement> said = statements(GetParam(), teams);
        EXPECT_NEAR(said.back().fraction, 1, 1e-9);
        expect_true(said);
    }
}

TEST_P(ForecastOf, FractionsOfAShareComeTrue)
{
    const std::vector<Statement> all = statements(GetParam(), 2);
    const std::vector<Statement> most = statements(GetParam(), 2, 0.9);
    EXPECT_LT(most.back().quanta, 0.9 * all.back().quanta);
    EXPECT_GT(most.back().fraction, 0.9);
    expect_true(most);
}

INSTANTIATE_TEST_SUITE_P(Exponents, ForecastOf, testing::Values(0.5, 0.35, 0.25));

TEST(Forecast, NeverAsksForMoreThanThePlanHas)
{
    const BlockGrid grid = grid_of_blocks(32, 16);
    const std::vector<Quantum> plan = quanta_of(160);
    Schedule schedule{.blocks = std::vector<BlockState>(2)};
    for (BlockState& block : schedule.blocks) block = {5, 5, false, {100 * error_unit, 0}};
    Forecast forecast;
    forecast.observe(schedule);
    ASSERT_TRUE(begin_adaptive_round(schedule, grid, plan, {}));
    EXPECT_NEAR(forecast.fraction(schedule, error_unit, int(plan.size())), 0.5, 1e-9);
}

}  // namespace
