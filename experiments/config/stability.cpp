#include "experiments/config/stability.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "experiments/stability/suite.hpp"

namespace experiments::config {
namespace {

/// The items of the list `key`, or nothing if the key is absent.
const std::vector<Node>* list_of(Table& table, const std::string& key) {
    const Node* node = table.find(key);
    if (!node) return nullptr;
    if (node->kind != Node::Kind::array)
        fail(*node, fmt::format("'{}' is {}; expected a list of numbers", key, describe(*node)));
    return &node->items;
}

int read_test(const Node& node) {
    const auto* number = std::get_if<std::int64_t>(&node.scalar);
    if (node.kind == Node::Kind::scalar && number)
        for (const stability::StressTest& test : stability::suite())
            if (test.number == *number) return test.number;
    fail(node, fmt::format("'tests' holds what is no test; expected numbers from {} to {}",
                           stability::suite().front().number, stability::suite().back().number));
}

double read_scale(const Node& node) {
    if (node.kind == Node::Kind::scalar) {
        const auto* real = std::get_if<double>(&node.scalar);
        const auto* integer = std::get_if<std::int64_t>(&node.scalar);
        const double scale = real ? *real : integer ? double(*integer) : 0;
        // Wider, and products of coordinates leave the range of single precision.
        if (scale >= 1e-6 && scale <= 1e6) return scale;
    }
    fail(node, "'scales' holds what is no scale; expected numbers from 1e-6 to 1e6");
}

}  // namespace

stability::Selection read_stability(Table& table) {
    stability::Selection selection;
    if (const std::vector<Node>* tests = list_of(table, "tests")) {
        for (const Node& node : *tests) selection.tests.push_back(read_test(node));
        if (tests->empty()) fail(*table.find("tests"), "'tests' is empty; leave it out for all");
        std::sort(selection.tests.begin(), selection.tests.end());
        selection.tests.erase(std::unique(selection.tests.begin(), selection.tests.end()),
                              selection.tests.end());
    } else {
        for (const stability::StressTest& test : stability::suite())
            selection.tests.push_back(test.number);
    }
    selection.transforms = int(table.integer("transforms", 0, 1000).value_or(selection.transforms));
    selection.orders = int(table.integer("orders", 0, 1000).value_or(selection.orders));
    if (const std::vector<Node>* scales = list_of(table, "scales")) {
        selection.scales.clear();
        for (const Node& node : *scales) selection.scales.push_back(read_scale(node));
    }
    return selection;
}

nlohmann::json to_json(const stability::Selection& selection) {
    return {{"tests", selection.tests},
            {"transforms", selection.transforms},
            {"orders", selection.orders},
            {"scales", selection.scales}};
}

}  // namespace experiments::config
