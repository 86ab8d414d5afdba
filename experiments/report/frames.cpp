#include "experiments/report/frames.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "experiments/measure/statistics.hpp"
#include "experiments/measure/summary.hpp"
#include "experiments/report/html.hpp"

namespace experiments::report {
namespace {

constexpr double kWidth = 860, kHeight = 420, kLeft = 76, kRight = 20, kBottom = 46;
constexpr double kTitle = 34, kLine = 20;  ///< heights, of the title and a line of the legend
constexpr std::size_t kSeries = 8;         ///< colours of the style sheet
constexpr std::size_t kLongest = 100;      ///< bytes of a label

/// 1, 2 or 5 times a power of ten, five to ten of which reach `high`; at least `least`.
double step_for(double high, double least) {
    const double power = std::pow(10, std::floor(std::log10(std::max(high, least) / 5)));
    for (const double step : {1.0, 2.0, 5.0})
        if (high / (step * power) <= 10) return std::max(least, step * power);
    return std::max(least, 10 * power);
}

}  // namespace

std::vector<Curve> find_curves(std::span<const measure::Row> rows, const std::string& scene) {
    std::vector<std::string> labels;
    std::map<std::string, std::map<int, std::vector<double>>> values;
    int last = 0;
    for (const measure::Row& row : rows) {
        if (row.key.scene != scene || row.sample.metric != "total_ms") continue;
        const std::string label =
            measure::ResultSummary{scene, row.key.method, row.key.variant, {}}.label();
        if (!values.contains(label)) labels.push_back(label);
        values[label][row.key.frame].push_back(row.sample.value);
        last = std::max(last, row.key.frame);
    }
    std::vector<Curve> curves;
    if (last == 0) return curves;
    for (const std::string& label : labels) {
        Curve& curve = curves.emplace_back(Curve{label, {}, {}});
        for (const auto& [frame, milliseconds] : values[label]) {
            curve.frames.push_back(frame);
            curve.milliseconds.push_back(measure::statistics(milliseconds).median);
        }
    }
    return curves;
}

std::string frame_chart(const std::string& title, std::span<const Curve> curves) {
    double slowest = 1e-6, last = 1;
    for (const Curve& curve : curves) {
        slowest = std::max(slowest, *std::ranges::max_element(curve.milliseconds));
        last = std::max(last, double(curve.frames.back()));
    }
    const double top = kTitle + kLine * double(curves.size()) + 8, bottom = top + kHeight - kBottom;
    const auto x = [&](double frame) { return kLeft + (kWidth - kLeft - kRight) * frame / last; };
    const auto y = [&](double ms) { return bottom - (bottom - top) * ms / (1.05 * slowest); };

    std::string svg = fmt::format(
        "<svg class=\"pareto\" viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"{}\">\n"
        "<text class=\"title\" x=\"{}\" y=\"24\">{}</text>\n",
        kWidth, bottom + kBottom, escape(title), kLeft, escape(title));
    const double step = step_for(slowest, 1e-6);
    for (int i = 0; i * step <= 1.05 * slowest; ++i)
        svg += fmt::format(
            "<path class=\"grid\" d=\"M{} {:.1f}H{}\"/>"
            "<text class=\"tick value\" x=\"{}\" y=\"{:.1f}\">{:g}</text>\n",
            kLeft, y(i * step), kWidth - kRight, kLeft - 8, y(i * step) + 4, i * step);
    for (double frame = 0; frame <= last; frame += step_for(last, 1))
        svg += fmt::format("<text class=\"tick middle\" x=\"{:.1f}\" y=\"{}\">{}</text>\n",
                           x(frame), bottom + 16, frame);
    svg += fmt::format(
        "<text class=\"soft middle\" x=\"{}\" y=\"{}\">frame</text>\n"
        "<text class=\"soft middle\" transform=\"translate(16 {}) rotate(-90)\">total_ms: build "
        "and query, milliseconds</text>\n",
        (kLeft + kWidth - kRight) / 2, bottom + 36, (top + bottom) / 2);
    for (std::size_t c = 0; c < curves.size(); ++c) {
        const Curve& curve = curves[c];
        std::string line;
        for (std::size_t i = 0; i < curve.frames.size(); ++i)
            line += fmt::format("{}{:.1f} {:.1f}", i == 0 ? 'M' : 'L', x(curve.frames[i]),
                                y(curve.milliseconds[i]));
        // More curves than colours: the second round is dashed, and so on.
        const std::string dashes =
            c < kSeries ? "" : fmt::format(" stroke-dasharray=\"{} 4\"", 12 / (c / kSeries));
        const double at = kTitle + kLine * double(c) + 8;
        svg += fmt::format(
            "<path class=\"curve s{0}\"{1} d=\"M{2} {3}h24\"/>"
            "<text x=\"{4}\" y=\"{5}\">{6}</text><path class=\"curve s{0}\"{1} d=\"{7}\"/>\n",
            c % kSeries, dashes, kLeft, at, kLeft + 32, at + 4,
            escape(shortened(curve.label, kLongest)), line);
    }
    return svg + "</svg>\n";
}

}  // namespace experiments::report
