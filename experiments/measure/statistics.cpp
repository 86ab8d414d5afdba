#include "experiments/measure/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace experiments::measure {
namespace {

/// Largest k (counted from 1) for which [x(k), x(n + 1 - k)] covers the median with at least 95 %.
/// The interval misses it when fewer than k values lie on one side, and the number on one side is
/// binomial with p = 1/2: twice the tail P(B < k) must stay below 5 %.
int order_rank(int n) {
    double log_choose = 0;  // log of (n over j)
    double tail = 0;
    int rank = 1;
    for (int j = 0; j < n / 2; ++j) {
        tail += std::exp(log_choose - n * std::log(2.0));
        if (2 * tail > 0.05) break;
        rank = j + 1;
        log_choose += std::log(double(n - j) / (j + 1));
    }
    return rank;
}

}  // namespace

Statistics statistics(std::span<const double> values) {
    std::vector<double> sorted(values.begin(), values.end());
    // What is no number goes last, so that the order is one.
    std::sort(sorted.begin(), sorted.end(),
              [](double a, double b) { return a < b || (std::isnan(b) && !std::isnan(a)); });
    Statistics result;
    result.n = int(sorted.size());
    const int half = result.n / 2;
    result.median = result.n % 2 ? sorted[half] : 0.5 * (sorted[half - 1] + sorted[half]);
    result.min = sorted.front();
    result.max = sorted.back();
    for (double value : sorted) result.mean += value / result.n;
    double squares = 0;
    for (double value : sorted) squares += (value - result.mean) * (value - result.mean);
    if (result.n > 1) result.stddev = std::sqrt(squares / (result.n - 1));
    const int rank = order_rank(result.n);
    result.ci_low = sorted[rank - 1];
    result.ci_high = sorted[result.n - rank];
    return result;
}

}  // namespace experiments::measure
