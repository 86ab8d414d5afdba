#include "experiments/report/charts.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "experiments/measure/summary.hpp"
#include "experiments/report/html.hpp"

namespace experiments::report {
namespace {

// A narrow drawing with the labels above the bars: it stays readable on a phone, where the page
// shows it at about this many pixels.
constexpr double kWidth = 400, kMargin = 14, kTitle = 32, kRow = 44, kBarHeight = 14;

/// Of a label, in bytes: what fits beside a value.
constexpr std::size_t kLongest = 44;

}  // namespace

std::string bar_chart(const std::string& title, const std::string& unit,
                      std::span<const Bar> bars) {
    double largest = 0;
    for (const Bar& bar : bars) largest = std::max(largest, bar.statistics.max);
    const double scale = largest > 0 ? (kWidth - 2 * kMargin) / largest : 0;
    const auto x = [&](double value) { return kMargin + scale * std::max(0.0, value); };
    const double height = kTitle + kRow * double(bars.size()) + 6;

    std::string svg = fmt::format(
        "<svg class=\"chart\" viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"{}\">\n"
        "<text class=\"title\" x=\"{}\" y=\"21\">{}</text>\n",
        kWidth, height, escape(title), kMargin, escape(title));
    for (std::size_t i = 0; i < bars.size(); ++i) {
        const auto& s = bars[i].statistics;
        const double top = kTitle + kRow * double(i);
        const double bar_top = top + 19, middle = bar_top + kBarHeight / 2;
        svg += fmt::format(
            "<text x=\"{}\" y=\"{}\">{}</text><text class=\"value\" x=\"{}\" y=\"{}\">{}</text>\n",
            kMargin, top + 13, escape(shortened(bars[i].label, kLongest)), kWidth - kMargin,
            top + 13, escape(measure::readable(s.median, unit)));
        svg += fmt::format(
            "<rect class=\"track\" x=\"{0}\" y=\"{1}\" width=\"{2}\" height=\"{3}\" rx=\"2\"/>"
            "<rect class=\"bar\" x=\"{0}\" y=\"{1}\" width=\"{4:.2f}\" height=\"{3}\" rx=\"2\"/>\n",
            kMargin, bar_top, kWidth - 2 * kMargin, kBarHeight,
            std::max(1.0, x(s.median) - kMargin));
        svg += fmt::format(
            "<path class=\"spread\" d=\"M{0:.2f} {2}H{1:.2f}M{0:.2f} {3}v8M{1:.2f} {3}v8\"/>"
            "<path class=\"spread thick\" d=\"M{4:.2f} {2}H{5:.2f}\"/>\n",
            x(s.min), x(s.max), middle, middle - 4, x(s.ci_low), x(s.ci_high));
    }
    return svg + "</svg>\n";
}

}  // namespace experiments::report
