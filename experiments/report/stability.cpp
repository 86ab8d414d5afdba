#include "experiments/report/stability.hpp"

#include <fmt/format.h>

#include "experiments/measure/stability_matrix.hpp"
#include "experiments/report/html.hpp"
#include "experiments/stability/suite.hpp"

namespace experiments::report {
namespace {

using measure::Cell;

constexpr const char* kHead =
    "<h2>Tests and methods</h2>\n"
    "<p class=\"soft\">Green: every instance of the test passed, and how many there were. Red: how "
    "many failed, with the points wrongly called lit, wrongly called dark, answered inexactly "
    "where exactness was asked for, left unanswered, and the errors thrown; below, the worst "
    "point.</p>\n";

std::string what_it_checks(const std::string& label) {
    for (const stability::StressTest& test : stability::suite())
        if (test.label() == label) return std::string(test.checks);
    return {};
}

std::string html_cell(const Cell& cell) {
    if (!cell.taken) return "<td>–</td>";
    std::string html =
        fmt::format("<td class=\"{}\">{}", cell.passed ? "pass" : "fail", escape(cell.text));
    if (!cell.worst.empty()) html += "<span class=\"spread\">" + escape(cell.worst) + "</span>";
    return html + "</td>";
}

}  // namespace

std::string stability_section(std::span<const measure::ResultSummary> results) {
    const measure::Matrix matrix = measure::make_matrix(results);
    std::string html = kHead;
    html += "<div class=\"scroll\"><table class=\"matrix\">\n<tr><th>test</th>";
    for (const std::string& method : matrix.methods) html += "<th>" + escape(method) + "</th>";
    html += "</tr>\n";
    for (std::size_t t = 0; t < matrix.tests.size(); ++t) {
        html += fmt::format("<tr><td>{}<span class=\"spread\">{}</span></td>",
                            escape(matrix.tests[t]), escape(what_it_checks(matrix.tests[t])));
        for (std::size_t m = 0; m < matrix.methods.size(); ++m)
            html += html_cell(matrix.cell(t, m));
        html += "</tr>\n";
    }
    return html + "</table></div>\n";
}

}  // namespace experiments::report
