#include "host/scene/alias_table.hpp"

namespace diptych {

// Michael Vose, "A linear algorithm for generating random numbers with a given distribution", 1991.
std::vector<AliasEntry> alias_table(std::span<const double> weights)
{
    double total = 0;
    for (const double weight : weights) {
        total += weight;
    }
    if (!(total > 0)) {
        return {};
    }

    const int count = int(weights.size());
    std::vector<AliasEntry> table(weights.size());
    std::vector<double> rest(weights.size());  // of each outcome, in units of a column
    std::vector<int> small, large;
    for (int k = 0; k < count; ++k) {
        table[k] = {1, k, float(weights[k] / total), 0};
        rest[k] = weights[k] / total * count;
        (rest[k] < 1 ? small : large).push_back(k);
    }
    while (!small.empty() && !large.empty()) {
        const int column = small.back(), donor = large.back();
        small.pop_back();
        table[column].threshold = float(rest[column]);
        table[column].alias = donor;
        rest[donor] -= 1 - rest[column];
        if (rest[donor] < 1) {
            large.pop_back();
            small.push_back(donor);
        }
    }
    // What rounding left over keeps its column whole, unless it must never be chosen.
    for (const int k : small) {
        if (weights[k] > 0) {
            continue;
        }
        for (int other = 0; other < count; ++other) {
            if (weights[other] > 0) {
                table[k].threshold = 0, table[k].alias = other;
            }
        }
    }
    return table;
}

}  // namespace diptych
