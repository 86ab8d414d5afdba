// One measured number, as it lands in samples.csv.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace structures {

/// `metric` is one of the names of the metric list (`grove list metrics`); `unit` is "ms", "bytes",
/// "1" (a count or ratio), ...
struct Sample {
    std::string metric;
    double value = 0;
    std::string unit = "1";
};
using Samples = std::vector<Sample>;

/// The value of the first sample of `metric`, or 0 if there is none.
inline double value_of(const Samples& samples, std::string_view metric) {
    for (const Sample& sample : samples)
        if (sample.metric == metric) return sample.value;
    return 0;
}

}  // namespace structures
