// One measured number, as it lands in samples.csv.
#pragma once

#include <string>
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

}  // namespace structures
