// Whether counts follow a distribution: Pearson's chi-square test.
#pragma once

#include <cmath>
#include <vector>

// Probability that a chi-square variable of `freedom` degrees exceeds x: the regularised upper
// incomplete gamma function Q(freedom / 2, x / 2), by its series or its continued fraction.
inline double chi_square_tail(double x, double freedom)
{
    const double a = freedom / 2, y = x / 2;
    if (y <= 0) return 1;
    const double front = std::exp(a * std::log(y) - y - std::lgamma(a));
    if (y < a + 1) {
        double term = 1 / a, sum = term;
        for (int n = 1; n < 10000 && term > sum * 1e-15; ++n) sum += term *= y / (a + n);
        return 1 - front * sum;
    }
    double b = y + 1 - a, c = 1e300, d = 1 / b, h = d;
    for (int n = 1; n < 10000; ++n) {
        const double an = -n * (n - a);
        b += 2;
        d = 1 / (an * d + b);
        c = b + an / c;
        h *= d * c;
        if (std::abs(d * c - 1) < 1e-14) break;
    }
    return front * h;
}

// Bins of fewer than five expected counts are put together.
inline double chi_square_probability(const std::vector<double>& expected,
                                     const std::vector<double>& observed)
{
    double statistic = 0, rest_expected = 0, rest_observed = 0;
    int bins = 0;
    const auto add = [&](double e, double o) {
        statistic += (o - e) * (o - e) / e;
        ++bins;
    };
    for (size_t k = 0; k < expected.size(); ++k) {
        if (expected[k] >= 5) {
            add(expected[k], observed[k]);
        } else {
            rest_expected += expected[k];
            rest_observed += observed[k];
        }
    }
    if (rest_expected >= 5)
        add(rest_expected, rest_observed);
    else if (rest_observed > 25)
        return 0;
    return chi_square_tail(statistic, bins - 1);
}

// The least probability that one of `tests` tests may give at an overall significance of 1e-4
// (Sidak 1967).
inline double sidak_level(int tests) { return -std::expm1(std::log1p(-1e-4) / tests); }
