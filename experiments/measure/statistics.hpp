// Median, spread and a confidence interval of repeated measurements.
#pragma once

#include <span>

namespace experiments::measure {

struct Statistics {
    int n = 0;
    double median = 0, min = 0, max = 0, mean = 0;
    double stddev = 0;  ///< of the sample, with n - 1; 0 for a single value
    /// Confidence interval of the median, 95 % or the best the sample allows: the narrowest
    /// symmetric pair of order statistics x(k), x(n + 1 - k) that covers the median of any
    /// distribution with that probability. Up to five values reach less than 95 %: min and max.
    double ci_low = 0, ci_high = 0;
};

/// Of at least one value.
Statistics statistics(std::span<const double> values);

}  // namespace experiments::measure
