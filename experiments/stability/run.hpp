// kind = "stability": every method of the config on every scene of the stress suite, varied.
#pragma once

#include "experiments/measure/session.hpp"

namespace experiments::stability {

/// Runs the tests that are not in the samples yet. What a method fails is in its samples; that is
/// a failure of the run only for methods that claim exactness. So are scenes about which the judge
/// and the suite do not agree.
void run_stability(measure::Session& session);

}  // namespace experiments::stability
