// Integer ranges, to leave alone what can neither overflow nor reach beyond an array.
#pragma once

#include <algorithm>

namespace texture_tool {

// Of 32-bit values, computed in 64 bits and saturated far outside of 32. low > high does not occur.
struct Interval {
    static constexpr long far = 1L << 40;
    long low = -far;
    long high = far;

    bool is_within(long first, long last) const { return low >= first && high <= last; }
};

inline Interval saturate(double low, double high)
{
    const double far = static_cast<double>(Interval::far);
    return {static_cast<long>(std::max(low, -far)), static_cast<long>(std::min(high, far))};
}
inline Interval add(Interval a, Interval b)
{
    return saturate(static_cast<double>(a.low + b.low), static_cast<double>(a.high + b.high));
}
inline Interval subtract(Interval a, Interval b)
{
    return saturate(static_cast<double>(a.low - b.high), static_cast<double>(a.high - b.low));
}
inline Interval multiply(Interval a, Interval b)
{
    const double products[] = {
        static_cast<double>(a.low) * static_cast<double>(b.low),
        static_cast<double>(a.low) * static_cast<double>(b.high),
        static_cast<double>(a.high) * static_cast<double>(b.low),
        static_cast<double>(a.high) * static_cast<double>(b.high),
    };
    return saturate(*std::min_element(products, products + 4),
                    *std::max_element(products, products + 4));
}
inline Interval join(Interval a, Interval b)
{
    return {std::min(a.low, b.low), std::max(a.high, b.high)};
}

}  // namespace texture_tool
