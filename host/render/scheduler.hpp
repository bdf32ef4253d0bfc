// What is to be rendered next: the film's blocks, how many samples each has, and the list of work
// that the render loop executes. Pure data in, pure data out; no device, no clock.
//
// Work goes in rounds. A round gives every active block a target; its list of work is then fixed.
// Decisions are taken between rounds only, so that a picture depends neither on how many work items
// a dispatch holds nor on who runs them.
//
// The blocks of an adaptive render form two teams with rounds of their own, which take turns: while
// the list of one is under way, the next round of the other is decided, and devices never run dry.
// A decision sees the errors of the other team as they were when that team last decided.
#pragma once

#include "platform.h"

#include "common/layout.h"

#include <span>
#include <vector>

namespace diptych {

struct Pixel {
    int x;
    int y;
};

// Samples of a pixel that are rendered together: a power of two up to QUANTUM, all of one batch of
// common/random.h.
struct Quantum {
    int first_sample;
    int samples;
};

// The sample plan of a render: the quanta of samples first to end - 1, in order.
std::vector<Quantum> quanta_of(int first, int end);
std::vector<Quantum> quanta_of(int samples);

// The parts of a picture that are scheduled as wholes: square blocks in Morton order, or one pixel.
struct BlockGrid {
    int width = 0;  // of the picture
    int height = 0;
    int shift = BLOCK_SHIFT;     // log2 of a block's side
    std::vector<Pixel> corners;  // lowest pixels

    int pixel_shift() const { return 2 * shift; }  // log2 of the pixels in a block
};
BlockGrid grid_of_blocks(int width, int height, int shift = BLOCK_SHIFT);
BlockGrid grid_of_pixel(int width, int height, Pixel pixel);

// Lowest pixels of the picture's blocks in Morton order.
std::vector<Pixel> blocks_of(int width, int height, int shift = BLOCK_SHIFT);

// The predicted error of a block, in 1/1024 JND: whole numbers, so that decisions are the same
// wherever they are taken.
struct BlockError {
    int rms = 0;          // over the block
    int worst_pixel = 0;  // the largest
};
inline constexpr int error_unit = 1024;

// How far it is from a target: the larger of the RMS and of a quarter of the worst pixel, rounded
// up.
int error_of(const BlockError& error);

// Where a block stands; quanta and target count entries of the sample plan.
struct BlockState {
    int quanta = 0;  // merged into the film
    int target = 0;  // to be merged by the end of the round
    bool is_done = false;
    BlockError error = {};  // adaptive: when the round was decided
};

// Where a render stands. Together with the film it is complete after every dispatch: what the
// rounds under way still have to do is every (block, quantum) with quanta <= quantum < target.
struct Schedule {
    int round = 0;  // how many have begun
    int level = 0;  // how often the error target has been lowered
    int pilot = 0;  // quanta at the start of each block that the film has forgotten again
    int teams = 1;  // block b belongs to team b % teams
    int turn = 0;   // the team that decides next: its round is the older one
    std::vector<BlockState> blocks;
};

// Calls visit(block) for each of a team's.
template<class Visit>
void for_team(const Schedule& schedule, int team, const Visit& visit)
{
    for (size_t b = size_t(team); b < schedule.blocks.size(); b += size_t(schedule.teams)) visit(b);
}

// A quantum of a block, by their indices.
struct Work {
    int block;
    int quantum;
};

// When a block of an adaptive render is done.
struct Targets {
    int error = error_unit;  // in 1/1024 JND, above 0
    int least_samples = 64;  // before any decision
    bool is_unbiased = false;
    double share = 1;  // of the blocks, below 1: when so many are below the error, all end
};

// How many of the blocks a share of them is, rounded up.
size_t share_of(double share, size_t blocks);

// The next round of the team whose turn it is, whose errors have been measured; the turn goes on.
// Each block that is not done gets as many quanta as its error asks for, at most as many as it has.
// A block is done when its error is at most the target, that of each of its pixels at most four
// times and those of all its neighbours at most twice the target, or when the plan ends. False when
// all of the team are, or enough of all blocks are below the error.
//
// With is_unbiased, and one team, the first least_samples of each block only say how many it needs;
// schedule.pilot then becomes the number of quanta that the film is to forget.
bool begin_adaptive_round(Schedule& schedule, const BlockGrid& grid, std::span<const Quantum> plan,
                          const Targets& targets);

bool is_round_done(const Schedule& schedule, int team);

// What is left of the round, pass by pass over the blocks. Quanta of different sizes never
// alternate: the list falls into as few stretches of equal size as the plan has.
std::vector<Work> work_by_pass(const Schedule& schedule);

// The same of a team, block by block, those of large error first; a block's quanta are neighbours.
std::vector<Work> work_by_block(const Schedule& schedule, std::span<const Quantum> plan, int team);

// The next round of a uniform render: some passes over all blocks. False when the plan is done.
bool begin_uniform_round(Schedule& schedule, int plan_length);

// How many entries from `first` on may share a dispatch of at most `most` items.
size_t dispatch_length(std::span<const Work> work, size_t first, size_t most,
                       std::span<const Quantum> plan);

}  // namespace diptych
