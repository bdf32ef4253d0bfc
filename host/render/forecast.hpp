// How far an adaptive render has come, from the trend of its blocks' errors.
#pragma once

#include "host/render/scheduler.hpp"

namespace diptych {

class Forecast {
public:
    // To be told of the errors of the team whose turn it is each time that they have been measured.
    void observe(const Schedule& schedule);

    // Of the quanta that the blocks will have had in the end, at most plan_length each: the share
    // that is there. target, share: as in Targets.
    double fraction(const Schedule& schedule, int target, int plan_length, double share = 1) const;

private:
    // When a block's error was last measured.
    struct Look {
        int quanta = 0;
        int error = 0;
    };

    double exponent() const;

    std::vector<Look> looks_;  // by block; empty before the first
    double fall_ = 0;          // of the logarithms of errors from look to look, summed
    double rise_ = 0;          // of those of samples
};

}  // namespace diptych
