#include "experiments/measure/stability_matrix.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "experiments/measure/session.hpp"

namespace experiments::measure {
namespace {

/// What went wrong, as far as it did: "5 lit, 1 thrown".
std::string faults(const ResultSummary& result) {
    struct Fault {
        const char *metric, *text;
    };
    std::string text;
    for (const Fault& fault : {Fault{"false_lit", "lit"}, Fault{"false_shadowed", "dark"},
                               Fault{"unexpected", "inexact"}, Fault{"incomplete", "unanswered"},
                               Fault{"exceptions", "thrown"}}) {
        const double count = result.median(fault.metric);
        if (count > 0)
            text +=
                fmt::format("{}{} {}", text.empty() ? "" : ", ", readable(count, "1"), fault.text);
    }
    return text;
}

std::string worst_point(const ResultSummary& result) {
    if (!result.find("worst_x")) return {};
    return fmt::format("({:.9g}, {:.9g}, {:.9g})", result.median("worst_x"),
                       result.median("worst_y"), result.median("worst_z"));
}

Cell make_cell(const ResultSummary& result) {
    Cell cell{true, result.median("stability_passed") == 1};
    const double instances = result.median("instances");
    cell.text = cell.passed ? fmt::format("{}", instances)
                            : fmt::format("{} of {}: {}", result.median("instances_failed"),
                                          instances, faults(result));
    if (!cell.passed) cell.worst = worst_point(result);
    return cell;
}

std::size_t index_of(std::vector<std::string>& names, const std::string& name) {
    const auto found = std::find(names.begin(), names.end(), name);
    if (found != names.end()) return std::size_t(found - names.begin());
    names.push_back(name);
    return names.size() - 1;
}

}  // namespace

Matrix make_matrix(std::span<const ResultSummary> results) {
    Matrix matrix;
    for (const ResultSummary& result : results)
        if (result.method != kSceneRows) {
            index_of(matrix.tests, result.scene);
            index_of(matrix.methods, result.label());
        }
    std::sort(matrix.tests.begin(), matrix.tests.end());
    matrix.cells.resize(matrix.tests.size() * matrix.methods.size());
    for (const ResultSummary& result : results)
        if (result.method != kSceneRows)
            matrix.cells[index_of(matrix.tests, result.scene) * matrix.methods.size() +
                         index_of(matrix.methods, result.label())] = make_cell(result);
    return matrix;
}

std::vector<std::vector<std::string>> text_rows(const Matrix& matrix) {
    std::vector<std::vector<std::string>> rows{{"test"}};
    rows[0].insert(rows[0].end(), matrix.methods.begin(), matrix.methods.end());
    std::vector<int> passed(matrix.methods.size());
    for (std::size_t t = 0; t < matrix.tests.size(); ++t) {
        auto& row = rows.emplace_back(std::vector<std::string>{matrix.tests[t]});
        for (std::size_t m = 0; m < matrix.methods.size(); ++m) {
            const Cell& cell = matrix.cell(t, m);
            passed[m] += cell.passed;
            row.push_back(!cell.taken   ? "-"
                          : cell.passed ? "pass " + cell.text
                                        : "FAIL " + cell.text);
        }
    }
    auto& last = rows.emplace_back(std::vector<std::string>{"passed"});
    for (const int count : passed)
        last.push_back(fmt::format("{} of {}", count, matrix.tests.size()));
    return rows;
}

std::vector<std::string> broken_stability_claims(std::span<const ResultSummary> results) {
    std::vector<std::string> lines;
    for (const ResultSummary& result : results) {
        if (result.median("claims_exact") != 1 || result.median("stability_passed") == 1) continue;
        const std::string worst = worst_point(result);
        lines.push_back(fmt::format("{}, {}: claims to be exact, but fails {}{}{}", result.scene,
                                    result.label(), make_cell(result).text,
                                    worst.empty() ? "" : "; worst at ", worst));
    }
    return lines;
}

}  // namespace experiments::measure
