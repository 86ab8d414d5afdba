// The drawing of run time against error.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "experiments/report/html.hpp"
#include "experiments/report/labels.hpp"
#include "experiments/report/pareto.hpp"

namespace experiments::report {
namespace {

constexpr double kWidth = 860, kHeight = 520, kLeft = 76, kRight = 20, kTop = 66, kBottom = 50;
/// Height below the logarithmic part for the line of no error.
constexpr double kZeroRoom = 46;
constexpr double kMark = 5.5;
/// Of a label's text, for finding room.
constexpr double kLetter = 6.9, kLine = 14;
constexpr std::size_t kLongest = 40;  ///< bytes of it
constexpr std::size_t kSeries = 8;

/// A logarithmic axis from `low` to `high` on the values' side, `from` to `to` on the page's.
struct LogAxis {
    double low, high, from, to;
    /// Values beyond an end lie on it.
    double at(double value) const {
        return from + (to - from) * (std::log10(std::clamp(value, low, high)) - std::log10(low)) /
                          (std::log10(high) - std::log10(low));
    }
    /// Powers of ten within it; with 2 and 5 between them if there are few; equal steps if the
    /// axis is too short for these.
    std::vector<double> ticks() const {
        const int first = int(std::floor(std::log10(low))), last = int(std::ceil(std::log10(high)));
        std::vector<double> list;
        const auto add = [&](double value) {
            if (value >= low * 0.999 && value <= high * 1.001) list.push_back(value);
        };
        for (int power = first; power <= last; ++power)
            for (const double step : {1.0, 2.0, 5.0})
                if (step == 1 || last - first <= 3) add(step * std::pow(10, power));
        if (list.size() >= 3) return list;
        list.clear();
        const double step = std::pow(10, std::floor(std::log10((high - low) / 2)));
        for (double value = std::ceil(low / step) * step; value <= high; value += step) add(value);
        return list;
    }
};

/// "0.05", "200", "10,000", "1e-06".
std::string tick_text(double value) {
    if (value < 1e-3 || value > 1e6) return fmt::format("{:.3g}", value);
    return value >= 1 ? measure::readable(std::round(value), "1") : fmt::format("{:g}", value);
}

/// Outline of a mark: series differ by shape as well as by colour.
std::string mark_path(std::size_t series, double x, double y) {
    const double r = kMark;
    switch (series % 5) {
        case 0:
            return fmt::format("M{:.1f} {:.1f}a{r} {r} 0 1 0 {d} 0a{r} {r} 0 1 0 -{d} 0z", x - r, y,
                               fmt::arg("r", r), fmt::arg("d", 2 * r));
        case 1:
            return fmt::format("M{:.1f} {:.1f}h{d}v{d}h-{d}z", x - 0.9 * r, y - 0.9 * r,
                               fmt::arg("d", 1.8 * r));
        case 2:
            return fmt::format("M{:.1f} {:.1f}l{:.1f} {:.1f}h{:.1f}z", x, y - 1.2 * r, 1.15 * r,
                               2 * r, -2.3 * r);
        case 3:
            return fmt::format("M{:.1f} {:.1f}l{d} {d}l-{d} {d}l-{d} -{d}z", x, y - 1.3 * r,
                               fmt::arg("d", 1.3 * r));
        default:
            return fmt::format("M{:.1f} {:.1f}l{:.1f} {:.1f}h{:.1f}z", x, y + 1.2 * r, -1.15 * r,
                               -2 * r, 2.3 * r);
    }
}

/// Colour and shape tell the method already.
std::string label(const Tradeoff& one) {
    const bool plain = one.result->variant == "default";
    return plain ? one.result->method : one.result->variant;
}

class Chart {
  public:
    explicit Chart(std::span<const Tradeoff> list) : list_(list) {
        double fast = INFINITY, slow = 0, least = INFINITY, most = 0;
        for (const Tradeoff& one : list) {
            fast = std::min(fast, one.milliseconds.min);
            slow = std::max(slow, one.milliseconds.max);
            most = std::max(most, one.errors);
            if (one.errors > 0) least = std::min(least, one.errors);
            if (std::find(methods_.begin(), methods_.end(), one.result->method) == methods_.end())
                methods_.push_back(one.result->method);
        }
        fast = std::max(fast, 1e-6);  // a clock may be too coarse to see any time
        slow = std::max(slow, fast);
        const double room = std::pow(slow / fast, 0.08) * 1.1;
        x_ = {fast / room, slow * room, kLeft, kWidth - kRight};
        if (most == 0) least = most = 1;
        const double low = std::pow(10, std::floor(std::log10(least)));
        y_ = {low, std::max(std::pow(10, std::ceil(std::log10(most))), 10 * low),
              kHeight - kBottom - kZeroRoom, kTop};
    }

    std::string axes() const {
        std::string svg;
        for (const double value : x_.ticks())
            svg += fmt::format(
                "<path class=\"grid\" d=\"M{0:.1f} {1}V{2}\"/>"
                "<text class=\"tick middle\" x=\"{0:.1f}\" y=\"{3}\">{4}</text>\n",
                x_.at(value), kTop, zero() + 12, zero() + 28, tick_text(value));
        for (const double value : y_.ticks())
            svg += fmt::format(
                "<path class=\"grid\" d=\"M{0} {1:.1f}H{2}\"/>"
                "<text class=\"tick value\" x=\"{3}\" y=\"{4:.1f}\">{5}</text>\n",
                kLeft, y_.at(value), kWidth - kRight, kLeft - 8, y_.at(value) + 4,
                tick_text(value));
        return svg + fmt::format(
                         "<path class=\"zero\" d=\"M{0} {1}H{2}\"/>"
                         "<text class=\"tick value\" x=\"{3}\" y=\"{4}\">0</text>\n"
                         "<text class=\"soft middle\" x=\"{5}\" y=\"{6}\">total_ms: build and "
                         "query, milliseconds</text>\n"
                         "<text class=\"soft middle\" transform=\"translate(16 {7}) rotate(-90)\">"
                         "false_lit + false_shadowed per million points</text>\n",
                         kLeft, zero(), kWidth - kRight, kLeft - 8, zero() + 4,
                         (kLeft + kWidth - kRight) / 2, kHeight - 8, (kTop + zero()) / 2);
    }

    /// Names of the methods, above the plot.
    std::string legend() const {
        std::string svg;
        double x = kLeft;
        for (std::size_t i = 0; i < methods_.size(); ++i) {
            svg += fmt::format(
                "<path class=\"mark s{}\" d=\"{}\"/><text x=\"{}\" y=\"50\">{}</text>\n",
                i % kSeries, mark_path(i, x + kMark, 46), x + 16, escape(methods_[i]));
            x += 34 + 6.6 * double(methods_[i].size());
        }
        return svg;
    }

    /// What is reached by the best choice for each time.
    std::string front() const {
        std::vector<const Tradeoff*> members;
        for (const Tradeoff& one : list_)
            if (one.front) members.push_back(&one);
        std::sort(members.begin(), members.end(), [](const Tradeoff* a, const Tradeoff* b) {
            return a->milliseconds.median < b->milliseconds.median;
        });
        std::string path;
        for (const Tradeoff* one : members)
            path += path.empty() ? fmt::format("M{:.1f} {:.1f}", x(*one), y(*one))
                                 : fmt::format("H{:.1f}V{:.1f}", x(*one), y(*one));
        return fmt::format("<path class=\"front\" d=\"{}H{}\"/>\n", path, kWidth - kRight);
    }

    std::string marks() const {
        std::string svg;
        for (const Tradeoff& one : list_) {
            const std::size_t series = series_of(one);
            svg += fmt::format(
                "<path class=\"span s{0}\" d=\"M{1:.1f} {3:.1f}H{2:.1f}\"/>"
                "<path class=\"mark s{0}{4}\" d=\"{5}\"><title>{6} {7}: {8}, {9:.4g} "
                "errors per million</title></path>\n",
                series % kSeries, x_.at(one.milliseconds.min), x_.at(one.milliseconds.max), y(one),
                one.claims_exact ? "" : " open", mark_path(series, x(one), y(one)),
                escape(one.result->method), escape(one.result->variant),
                measure::readable(one.milliseconds.median, "ms"), one.errors);
        }
        return svg;
    }

    /// The front's labels come first and may lie farther away, joined to their marks by a line;
    /// others are left out where there is no room (their tooltips name them).
    std::string labels() const {
        std::vector<Box> taken;
        for (const Tradeoff& one : list_)
            taken.push_back({x(one) - kMark, y(one) - kMark, x(one) + kMark, y(one) + kMark});
        LabelPlaces places({kLeft, kTop, kWidth - kRight, zero() + 14}, taken);
        std::string svg;
        for (const bool front : {true, false})
            for (const Tradeoff& one : list_) {
                if (one.front != front) continue;
                const std::string text = shortened(label(one), kLongest);
                Box box{};
                if (!places.find(x(one), y(one), kLetter * double(text.size()), kLine,
                                 front ? 90 : 12, box))
                    continue;
                const double nearest_x = std::clamp(x(one), box.left, box.right);
                const double nearest_y = std::clamp(y(one), box.top, box.bottom);
                if (std::hypot(nearest_x - x(one), nearest_y - y(one)) > 16)
                    svg +=
                        fmt::format("<path class=\"leader\" d=\"M{:.1f} {:.1f}L{:.1f} {:.1f}\"/>",
                                    x(one), y(one), nearest_x, nearest_y);
                svg += fmt::format(
                    "<text class=\"label middle{}\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n",
                    front ? " strong" : "", (box.left + box.right) / 2, box.bottom - 3.5,
                    escape(text));
            }
        return svg;
    }

  private:
    double zero() const { return kHeight - kBottom; }
    double x(const Tradeoff& one) const { return x_.at(one.milliseconds.median); }
    double y(const Tradeoff& one) const { return one.errors > 0 ? y_.at(one.errors) : zero(); }
    std::size_t series_of(const Tradeoff& one) const {
        return std::size_t(std::find(methods_.begin(), methods_.end(), one.result->method) -
                           methods_.begin());
    }

    std::span<const Tradeoff> list_;
    std::vector<std::string> methods_;
    LogAxis x_{}, y_{};
};

}  // namespace

std::string pareto_chart(const std::string& title, std::span<const Tradeoff> tradeoffs) {
    const Chart chart(tradeoffs);
    return fmt::format(
        "<svg class=\"pareto\" viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"{}\">\n"
        "<text class=\"title\" x=\"{}\" y=\"24\">{}</text>\n{}{}{}{}{}</svg>\n",
        kWidth, kHeight, escape(title), kLeft, escape(title), chart.legend(), chart.axes(),
        chart.front(), chart.marks(), chart.labels());
}

}  // namespace experiments::report
