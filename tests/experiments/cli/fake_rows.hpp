// A structure and a shadow method without any work behind them, for tests of the program around
// them.
#pragma once

#include "experiments/measure/session.hpp"

namespace tests {

/// Structure `fake_tree` and shadow methods `stripes` and `rival`; what they do wrong on request is
/// said by their parameters.
experiments::measure::Registries fake_registries();

}  // namespace tests
