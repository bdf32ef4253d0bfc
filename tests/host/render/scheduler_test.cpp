// Lists of work and decisions of the block scheduler, without anything being rendered.
#include "host/render/scheduler.hpp"

#include <gtest/gtest.h>

namespace {

using namespace diptych;

constexpr int one = error_unit;

Schedule schedule_of(const BlockGrid& grid)
{
    Schedule schedule;
    schedule.blocks.resize(grid.corners.size());
    return schedule;
}

void finish(Schedule& schedule)
{
    for (BlockState& block : schedule.blocks) block.quanta = block.target;
}

// All blocks rendered up to `quanta` entries of the plan.
Schedule rendered(const BlockGrid& grid, int quanta)
{
    Schedule schedule = schedule_of(grid);
    for (BlockState& block : schedule.blocks) block.quanta = block.target = quanta;
    return schedule;
}

// As if measured.
void set_errors(Schedule& schedule, const std::vector<BlockError>& errors)
{
    for (size_t b = 0; b < errors.size(); ++b) schedule.blocks[b].error = errors[b];
}

// Every quantum of a block comes once, in order, and sizes change as seldom as in the plan.
void expect_in_order(const std::vector<Work>& work, const std::vector<Quantum>& plan,
                     Schedule schedule)
{
    int changes = 0;
    for (size_t k = 0; k < work.size(); ++k) {
        BlockState& block = schedule.blocks[size_t(work[k].block)];
        EXPECT_EQ(work[k].quantum, block.quanta++) << "entry " << k;
        if (k > 0)
            changes +=
                plan[size_t(work[k].quantum)].samples != plan[size_t(work[k - 1].quantum)].samples;
    }
    int plan_changes = 0;
    for (size_t q = 1; q < plan.size(); ++q) plan_changes += plan[q].samples != plan[q - 1].samples;
    EXPECT_LE(changes, plan_changes);
    for (const BlockState& block : schedule.blocks) EXPECT_EQ(block.quanta, block.target);
}

TEST(Scheduler, PlansNeverCrossABatch)
{
    const std::vector<Quantum> plan = quanta_of(8, 61);
    int next = 8;
    for (const Quantum& quantum : plan) {
        EXPECT_EQ(quantum.first_sample, next);
        EXPECT_EQ(quantum.first_sample / QUANTUM,
                  (quantum.first_sample + quantum.samples - 1) / QUANTUM);
        next += quantum.samples;
    }
    EXPECT_EQ(next, 61);
}

TEST(Scheduler, UniformRendersGiveEachBlockEachQuantumOnce)
{
    const BlockGrid grid = grid_of_blocks(70, 40);
    const std::vector<Quantum> plan = quanta_of(16 * 3000 + 13);
    Schedule schedule = schedule_of(grid);
    while (begin_uniform_round(schedule, int(plan.size()))) {
        expect_in_order(work_by_pass(schedule), plan, schedule);
        finish(schedule);
    }
    for (const BlockState& block : schedule.blocks) EXPECT_EQ(block.quanta, int(plan.size()));
}

TEST(Scheduler, DispatchesHoldOneSizeOfQuantum)
{
    const std::vector<Quantum> plan = quanta_of(24);
    Schedule schedule = schedule_of(grid_of_blocks(48, 16));
    begin_uniform_round(schedule, int(plan.size()));
    const std::vector<Work> work = work_by_pass(schedule);
    EXPECT_EQ(dispatch_length(work, 0, 100, plan), 3u);
    EXPECT_EQ(dispatch_length(work, 0, 2, plan), 2u);
    EXPECT_EQ(dispatch_length(work, 3, 100, plan), 3u);
}

TEST(Scheduler, BeginsByDoublingUntilThereIsSomethingToDecideBy)
{
    const BlockGrid grid = grid_of_blocks(48, 48);
    const std::vector<Quantum> plan = quanta_of(1024);
    Schedule schedule = schedule_of(grid);
    std::vector<int> quanta;
    while (begin_adaptive_round(schedule, grid, plan, {})) {
        finish(schedule);
        quanta.push_back(schedule.blocks[4].quanta);
    }
    EXPECT_EQ(quanta, (std::vector<int>{1, 2, 4}));
}

TEST(Scheduler, AsksForWhatTheErrorNeedsAndAtMostDoubles)
{
    const BlockGrid grid = grid_of_blocks(16 * 5, 16);
    const std::vector<Quantum> plan = quanta_of(16 * 64);
    Schedule schedule = rendered(grid, 16);
    // the root law: 1.25 times the error is 1.5625 times the samples, 9 quanta more
    set_errors(schedule,
               {{one * 5 / 4, 0}, {9 * one, 0}, {one / 2, 5 * one}, {one / 2, 0}, {0, 0}});
    ASSERT_TRUE(begin_adaptive_round(schedule, grid, plan, {}));
    EXPECT_EQ(schedule.blocks[0].target, 25);
    EXPECT_EQ(schedule.blocks[1].target, 32);
    EXPECT_EQ(schedule.blocks[2].target, 25);  // for one of its pixels
    expect_in_order(work_by_block(schedule, plan, 0), plan, schedule);
    EXPECT_EQ(work_by_block(schedule, plan, 0)[0].block, 1);  // the worst one first
}

TEST(Scheduler, AGoodBlockWaitsForBadNeighbours)
{
    const BlockGrid grid = grid_of_blocks(16 * 8, 16 * 8);
    const std::vector<Quantum> plan = quanta_of(4096);
    std::vector<BlockError> errors(grid.corners.size());
    const auto at = [&](int x, int y) {
        for (size_t b = 0; b < grid.corners.size(); ++b)
            if (grid.corners[b].x == 16 * x && grid.corners[b].y == 16 * y) return b;
        return size_t(0);
    };
    errors[at(3, 3)] = {2 * one + 1, 0};
    Schedule schedule = rendered(grid, 8);
    set_errors(schedule, errors);
    ASSERT_TRUE(begin_adaptive_round(schedule, grid, plan, {}));
    int active = 0;
    for (const BlockState& block : schedule.blocks) active += !block.is_done;
    EXPECT_EQ(active, 9);
    EXPECT_FALSE(schedule.blocks[at(4, 4)].is_done);
    EXPECT_EQ(schedule.blocks[at(4, 4)].target, 9);
    errors[at(3, 3)] = {2 * one, 0};  // not good itself, but good enough to stand beside
    schedule = rendered(grid, 8);
    set_errors(schedule, errors);
    ASSERT_TRUE(begin_adaptive_round(schedule, grid, plan, {}));
    active = 0;
    for (const BlockState& block : schedule.blocks) active += !block.is_done;
    EXPECT_EQ(active, 1);
}

TEST(Scheduler, EndsWithThePlan)
{
    const BlockGrid grid = grid_of_blocks(32, 16);
    const std::vector<Quantum> plan = quanta_of(100);
    Schedule schedule = schedule_of(grid);
    set_errors(schedule, {2, {1 << 30, 1 << 30}});
    while (begin_adaptive_round(schedule, grid, plan, {})) {
        expect_in_order(work_by_block(schedule, plan, 0), plan, schedule);
        finish(schedule);
    }
    for (const BlockState& block : schedule.blocks) EXPECT_EQ(block.quanta, int(plan.size()));
}

TEST(Scheduler, UnbiasedRendersDecideOnceByAPilot)
{
    const BlockGrid grid = grid_of_blocks(16 * 3, 16);
    const std::vector<Quantum> plan = quanta_of(4096);
    Targets targets;
    targets.is_unbiased = true;
    Schedule schedule = rendered(grid, 4);
    set_errors(schedule, {{4 * one, 0}, {0, 0}, {0, 0}});
    ASSERT_TRUE(begin_adaptive_round(schedule, grid, plan, targets));
    EXPECT_EQ(schedule.pilot, 4);
    EXPECT_EQ(schedule.blocks[0].target, 4 + 64);
    EXPECT_EQ(schedule.blocks[1].target, 4 + 16);  // half its neighbour's error
    EXPECT_EQ(schedule.blocks[2].target, 4 + 4);
    finish(schedule);
    set_errors(schedule, std::vector<BlockError>(3, {100 * one, 0}));
    EXPECT_FALSE(begin_adaptive_round(schedule, grid, plan, targets));
}

TEST(Scheduler, SharesAreRoundedUpButNotByRoundingErrors)
{
    EXPECT_EQ(share_of(1, 7), 7u);
    EXPECT_EQ(share_of(0.55, 100), 55u);  // 55.00000000000001
    EXPECT_EQ(share_of(0.95, 84), 80u);   // of 79.8
    EXPECT_EQ(share_of(0.01, 3), 1u);
}

TEST(Scheduler, AShareBelowTheTargetEndsAllAndHardBlocksDoNotRunAhead)
{
    const BlockGrid grid = grid_of_blocks(16 * 4, 16);
    const std::vector<Quantum> plan = quanta_of(1 << 16);
    Targets targets;
    targets.share = 0.75;
    Schedule schedule = rendered(grid, 8);
    set_errors(schedule, {{50 * one, 0}, {0, 0}, {6 * one / 5, 0}, {0, 0}});
    ASSERT_TRUE(begin_adaptive_round(schedule, grid, plan, targets));
    EXPECT_EQ(schedule.blocks[2].target, 12);  // 8 * 1.44, rounded up
    EXPECT_EQ(schedule.blocks[0].target, 12);  // not 16
    finish(schedule);
    set_errors(schedule, {{40 * one, 0}, {0, 0}, {one, 0}, {0, 0}});
    EXPECT_FALSE(begin_adaptive_round(schedule, grid, plan, targets));
    EXPECT_FALSE(schedule.blocks[0].is_done);
    targets.share = 0.76;
    EXPECT_TRUE(begin_adaptive_round(schedule, grid, plan, targets));
    EXPECT_EQ(schedule.blocks[0].target, 24);
}

TEST(Scheduler, TeamsDecideInTurnAndForTheirOwnBlocks)
{
    const BlockGrid grid = grid_of_blocks(16 * 4, 16);
    const std::vector<Quantum> plan = quanta_of(4096);
    Schedule schedule = rendered(grid, 8);
    schedule.teams = 2;
    set_errors(schedule, std::vector<BlockError>(4, {9 * one, 0}));
    ASSERT_TRUE(begin_adaptive_round(schedule, grid, plan, {}));
    EXPECT_EQ(schedule.turn, 1);
    EXPECT_FALSE(is_round_done(schedule, 0));
    EXPECT_TRUE(is_round_done(schedule, 1));
    for (size_t b = 0; b < 4; ++b) EXPECT_EQ(schedule.blocks[b].target, b % 2 == 0 ? 16 : 8);
    for (const Work& work : work_by_block(schedule, plan, 0)) EXPECT_EQ(work.block % 2, 0);
    EXPECT_TRUE(work_by_block(schedule, plan, 1).empty());
    set_errors(schedule, std::vector<BlockError>(4));
    EXPECT_FALSE(begin_adaptive_round(schedule, grid, plan, {}));
    EXPECT_EQ(schedule.turn, 0);
    for (size_t b = 0; b < 4; ++b) EXPECT_EQ(schedule.blocks[b].is_done, b % 2 == 1);
}

}  // namespace
