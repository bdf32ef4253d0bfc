// What went wrong with evaluations of textures, by kind: how often, and where first.
#pragma once

#include "backends/backend.hpp"

#include <array>

namespace diptych {

// The first pixel in the order of rendering (quanta of samples, blocks of the film, pixels of a
// block) with such a fault, among these samples.
struct TextureFault {
    unsigned long long count = 0;
    int x = -1;
    int y = -1;
    int first_sample = -1;
    int samples = 0;
};

// By TEXTURE_FAULT_*.
struct TextureFaults {
    std::array<TextureFault, TEXTURE_FAULT_COUNT> of_kind;

    bool any() const
    {
        for (const TextureFault& fault : of_kind)
            if (fault.count > 0) return true;
        return false;
    }

    // Result entry r, which is pixel x, y of an item that begins with this sample.
    void add(const Dispatch& dispatch, const Results& results, int r, int x, int y,
             int first_sample)
    {
        if (results.texture_faults.empty()) return;
        for (size_t k = 0; k < of_kind.size(); ++k) {
            const int count = results.texture_faults[k * size_t(dispatch.results()) + size_t(r)];
            if (count == 0) continue;
            if (of_kind[k].count == 0) of_kind[k] = {0, x, y, first_sample, dispatch.samples};
            of_kind[k].count += unsigned(count);
        }
    }
};

}  // namespace diptych
