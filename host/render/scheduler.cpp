#include "host/render/scheduler.hpp"

#include "common/random.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace diptych {

int error_of(const BlockError& error) { return std::max(error.rms, (error.worst_pixel + 3) / 4); }

size_t share_of(double share, size_t blocks)
{
    return size_t(std::ceil(share * double(blocks) - 1e-6));
}

std::vector<Quantum> quanta_of(int first, int end)
{
    std::vector<Quantum> quanta;
    while (first < end) {
        const int rest = std::min(end - first, QUANTUM - first % QUANTUM);
        const int size = int(std::bit_floor(unsigned(rest)));
        quanta.push_back({first, size});
        first += size;
    }
    return quanta;
}

std::vector<Quantum> quanta_of(int samples) { return quanta_of(0, samples); }

std::vector<Pixel> blocks_of(int width, int height, int shift)
{
    const int size = 1 << shift;
    std::vector<Pixel> blocks;
    for (int y = 0; y < height; y += size)
        for (int x = 0; x < width; x += size) blocks.push_back({x, y});
    std::sort(blocks.begin(), blocks.end(), [=](const Pixel& a, const Pixel& b) {
        return morton_code(a.x >> shift, a.y >> shift) < morton_code(b.x >> shift, b.y >> shift);
    });
    return blocks;
}

BlockGrid grid_of_blocks(int width, int height, int shift)
{
    return {width, height, shift, blocks_of(width, height, shift)};
}

BlockGrid grid_of_pixel(int width, int height, Pixel pixel) { return {width, height, 0, {pixel}}; }

std::vector<Work> work_by_pass(const Schedule& schedule)
{
    int first = 0, last = 0;
    bool is_first = true;
    for (const BlockState& block : schedule.blocks) {
        if (block.quanta >= block.target) continue;
        first = is_first ? block.quanta : std::min(first, block.quanta);
        last = std::max(last, block.target);
        is_first = false;
    }
    std::vector<Work> work;
    for (int quantum = first; quantum < last; ++quantum)
        for (size_t b = 0; b < schedule.blocks.size(); ++b)
            if (quantum >= schedule.blocks[b].quanta && quantum < schedule.blocks[b].target)
                work.push_back({int(b), quantum});
    return work;
}

bool is_round_done(const Schedule& schedule, int team)
{
    bool is_done = true;
    for_team(schedule, team, [&](size_t b) {
        is_done = is_done && schedule.blocks[b].quanta >= schedule.blocks[b].target;
    });
    return is_done;
}

std::vector<Work> work_by_block(const Schedule& schedule, std::span<const Quantum> plan, int team)
{
    std::vector<int> order;
    for_team(schedule, team, [&](size_t b) { order.push_back(int(b)); });
    std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
        return schedule.blocks[size_t(a)].error.rms > schedule.blocks[size_t(b)].error.rms;
    });
    std::vector<int> stretches(plan.size());  // of quanta of equal size
    for (size_t q = 1; q < plan.size(); ++q)
        stretches[q] = stretches[q - 1] + (plan[q].samples != plan[q - 1].samples ? 1 : 0);
    std::vector<Work> work;
    for (const int b : order)
        for (int q = schedule.blocks[size_t(b)].quanta; q < schedule.blocks[size_t(b)].target; ++q)
            work.push_back({b, q});
    std::stable_sort(work.begin(), work.end(), [&](const Work& a, const Work& b) {
        return stretches[size_t(a.quantum)] < stretches[size_t(b.quantum)];
    });
    return work;
}

bool begin_uniform_round(Schedule& schedule, int plan_length)
{
    // long enough to keep dispatches full, short enough to be listed
    const size_t wanted = 1 << 16;
    const int passes =
        int(std::max<size_t>(1, wanted / std::max<size_t>(1, schedule.blocks.size())));
    bool is_work_left = false;
    for (BlockState& block : schedule.blocks) {
        block.target = block.quanta + std::min(passes, plan_length - block.quanta);
        block.is_done = block.target == block.quanta;
        is_work_left = is_work_left || !block.is_done;
    }
    if (is_work_left) ++schedule.round;
    return is_work_left;
}

namespace {

// Where the blocks lie, to find neighbours.
class BlockMap {
public:
    explicit BlockMap(const BlockGrid& grid)
        : grid_(grid), columns_(((grid.width - 1) >> grid.shift) + 1),
          rows_(((grid.height - 1) >> grid.shift) + 1), at_(size_t(columns_) * size_t(rows_))
    {
        for (size_t b = 0; b < grid.corners.size(); ++b)
            at_[size_t(row(b)) * size_t(columns_) + size_t(column(b))] = int(b);
    }

    template<class Visit>
    void for_neighbours(size_t block, const Visit& visit) const
    {
        for (int y = std::max(row(block) - 1, 0); y <= std::min(row(block) + 1, rows_ - 1); ++y)
            for (int x = std::max(column(block) - 1, 0);
                 x <= std::min(column(block) + 1, columns_ - 1); ++x)
                visit(size_t(at_[size_t(y) * size_t(columns_) + size_t(x)]));
    }

private:
    int column(size_t block) const { return grid_.corners[block].x >> grid_.shift; }
    int row(size_t block) const { return grid_.corners[block].y >> grid_.shift; }

    const BlockGrid& grid_;
    int columns_;
    int rows_;
    std::vector<int> at_;
};

int samples_of(const BlockState& block, std::span<const Quantum> plan)
{
    if (block.quanta == 0) return 0;
    const Quantum& last = plan[size_t(block.quanta) - 1];
    return last.first_sample + last.samples - plan[0].first_sample;
}

// Until there are enough for a decision: twice as many, so that a first picture is there soon.
int doubled(const BlockState& block, std::span<const Quantum> plan)
{
    return std::min(std::max(1, 2 * block.quanta), int(plan.size()));
}

// The error falls as the root of the samples.
double samples_needed(int samples, int error, int target)
{
    const double ratio = double(error) / target;
    return samples * ratio * ratio;
}

bool is_converged(size_t block, const BlockMap& map, const std::vector<BlockState>& blocks,
                  int target)
{
    bool is_calm = error_of(blocks[block].error) <= target;
    if (is_calm)
        map.for_neighbours(block, [&](size_t other) {
            is_calm = is_calm && blocks[other].error.rms <= 2 * target;
        });
    return is_calm;
}

// As many samples again as the pilot's error asks for, a neighbour's half as large counting as
// well.
void begin_after_pilot(Schedule& schedule, const BlockMap& map, std::span<const Quantum> plan,
                       const Targets& targets)
{
    schedule.pilot = schedule.blocks[0].quanta;
    for (size_t b = 0; b < schedule.blocks.size(); ++b) {
        BlockState& block = schedule.blocks[b];
        int error = error_of(block.error);
        map.for_neighbours(
            b, [&](size_t o) { error = std::max(error, schedule.blocks[o].error.rms / 2); });
        const double needed = samples_needed(samples_of(block, plan), error, targets.error);
        const double quanta = std::ceil(std::max(needed, double(targets.least_samples)) / QUANTUM);
        block.target = int(std::min(block.quanta + quanta, double(plan.size())));
    }
}

// What a share of the blocks below the target asks of the others, by the errors as they were last
// measured; whether neighbours are calm is not asked. The other team's round is under way: what
// counts is how it will end, not how far it has come.
struct ShareNeeds {
    bool is_there = false;  // so many are below
    double quanta = 1e9;    // that the last of them will have had: others need no more
};

ShareNeeds needs_of_share(const Schedule& schedule, std::span<const Quantum> plan,
                          const Targets& targets, int least)
{
    ShareNeeds needs;
    if (targets.share >= 1) return needs;
    std::vector<double> quanta;
    size_t below = 0;
    for (size_t b = 0; b < schedule.blocks.size(); ++b) {
        const BlockState& block = schedule.blocks[b];
        const bool is_own = int(b) % schedule.teams == schedule.turn;
        const int samples = samples_of({block.target}, plan);
        const int error = error_of(block.error);
        const bool is_measured = samples > least || (is_own && samples == least) || block.is_done;
        const bool is_below = is_measured && error <= targets.error;
        below += is_below ? 1 : 0;
        quanta.push_back(is_below ? 0 : samples_needed(samples, error, targets.error) / QUANTUM);
    }
    const size_t wanted = share_of(targets.share, quanta.size());
    std::nth_element(quanta.begin(), quanta.begin() + std::ptrdiff_t(wanted) - 1, quanta.end());
    needs.is_there = below >= wanted;
    needs.quanta = std::ceil(std::max(quanta[wanted - 1], double(least) / QUANTUM));
    return needs;
}

}  // namespace

bool begin_adaptive_round(Schedule& schedule, const BlockGrid& grid, std::span<const Quantum> plan,
                          const Targets& targets)
{
    const BlockMap map(grid);
    const int length = int(plan.size());
    const int least = std::min(targets.least_samples, samples_of({length, 0, false}, plan));
    bool is_work_left = false, is_pilot_over = targets.is_unbiased && schedule.pilot == 0;
    for_team(schedule, schedule.turn, [&](size_t b) {
        BlockState& block = schedule.blocks[b];
        const int samples = samples_of(block, plan);
        is_pilot_over = is_pilot_over && samples >= least;
        block.is_done = block.is_done || block.quanta >= length || schedule.pilot > 0 ||
                        (samples >= least && !targets.is_unbiased &&
                         is_converged(b, map, schedule.blocks, targets.error));
    });
    const ShareNeeds of_share = needs_of_share(schedule, plan, targets, least);
    for_team(schedule, schedule.turn, [&](size_t b) {
        BlockState& block = schedule.blocks[b];
        if (block.is_done || of_share.is_there) return;
        const int samples = samples_of(block, plan);
        if (samples < least) {
            block.target = doubled(block, plan);
        } else {
            const double more =
                samples_needed(samples, error_of(block.error), targets.error) - samples;
            const double quanta = std::clamp(std::ceil(more / QUANTUM), 1.0,
                                             std::max(1.0, samples / double(QUANTUM)));
            const double most = std::max(of_share.quanta, double(block.quanta));
            block.target = int(std::min({block.quanta + quanta, most, double(length)}));
        }
        is_work_left = is_work_left || block.target > block.quanta;
    });
    if (is_pilot_over && is_work_left) begin_after_pilot(schedule, map, plan, targets);
    if (is_work_left) ++schedule.round;
    schedule.turn = (schedule.turn + 1) % schedule.teams;
    return is_work_left;
}

size_t dispatch_length(std::span<const Work> work, size_t first, size_t most,
                       std::span<const Quantum> plan)
{
    const int samples = plan[size_t(work[first].quantum)].samples;
    size_t length = 1;
    while (length < most && first + length < work.size() &&
           plan[size_t(work[first + length].quantum)].samples == samples)
        ++length;
    return length;
}

}  // namespace diptych
