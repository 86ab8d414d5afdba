// The outcome of the stress suite: test by test and method by method, who passed.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "experiments/measure/summary.hpp"

namespace experiments::measure {

struct Cell {
    bool taken = false;  ///< whether the method has taken the test
    bool passed = false;
    std::string text{};   ///< "62", or "3 of 62: 5 lit, 2 dark"
    std::string worst{};  ///< of a failure: the worst point, if an answer was wrong
};

struct Matrix {
    std::vector<std::string> methods;  ///< columns
    std::vector<std::string> tests;    ///< rows
    std::vector<Cell> cells;           ///< row by row

    const Cell& cell(std::size_t test, std::size_t method) const {
        return cells[test * methods.size() + method];
    }
};

Matrix make_matrix(std::span<const ResultSummary> results);

/// For a terminal: the header and a row per test and a last one with the number of tests passed.
std::vector<std::vector<std::string>> text_rows(const Matrix& matrix);

/// A line for every test that a method failed although it claims exactness.
std::vector<std::string> broken_stability_claims(std::span<const ResultSummary> results);

}  // namespace experiments::measure
