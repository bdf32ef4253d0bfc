#include "host/render/forecast.hpp"

#include <algorithm>
#include <cmath>

namespace diptych {
namespace {

constexpr int least_quanta = Targets{}.least_samples / QUANTUM;  // of a block
constexpr int unknown_quanta = 16;    // that a block will have, for all that is known
constexpr double memory = 0.5;        // of the trend, from round to round
constexpr double slowest_fall = 0.2;  // exponent; rare sparks let an error stand still for long

}  // namespace

void Forecast::observe(const Schedule& schedule)
{
    looks_.resize(schedule.blocks.size());
    fall_ *= memory;
    rise_ *= memory;
    for_team(schedule, schedule.turn, [&](size_t b) {
        const BlockState& block = schedule.blocks[b];
        if (block.is_done) return;
        Look& last = looks_[b];
        const int error = error_of(block.error);
        if (last.quanta >= least_quanta && block.quanta > last.quanta && last.error > 0 &&
            error > 0) {
            fall_ += std::log(double(last.error) / error);
            rise_ += std::log(double(block.quanta) / last.quanta);
        }
        last = {block.quanta, error};
    });
}

// The error falls as this power of the samples: a half, unless rare events still come up.
double Forecast::exponent() const
{
    return rise_ > 0 ? std::clamp(fall_ / rise_, slowest_fall, 0.5) : 0.5;
}

double Forecast::fraction(const Schedule& schedule, int target, int plan_length, double share) const
{
    const double power = 1 / exponent();
    std::vector<double> needed;
    for (size_t b = 0; b < schedule.blocks.size(); ++b) {
        const BlockState& block = schedule.blocks[b];
        double quanta = block.target;
        if (!block.is_done && (b >= looks_.size() || looks_[b].quanta < least_quanta)) {
            quanta = std::max(quanta, double(unknown_quanta));
        } else if (!block.is_done) {
            const double ratio = std::max(double(looks_[b].error) / target, 1.0);
            quanta = std::max(quanta, looks_[b].quanta * std::pow(ratio, power));
        }
        needed.push_back(std::min(quanta, double(plan_length)));
    }
    if (needed.empty()) return 1;
    // Blocks beyond the share go on until the last one within it is done.
    const auto last = needed.begin() + std::ptrdiff_t(share_of(share, needed.size())) - 1;
    std::nth_element(needed.begin(), last, needed.end());
    const double most = *last;
    double all = 0, there = 0;
    for (size_t b = 0; b < needed.size(); ++b) {
        all += std::min(needed[b], most);
        there += std::min(double(schedule.blocks[b].quanta), most);
    }
    return all > 0 ? there / all : 1;
}

}  // namespace diptych
