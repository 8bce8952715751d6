#pragma once

#include <vector>

#include "twin/diagnose/by_twin.h"
#include "twin/diagnose/compared.h"

namespace twinbench::diagnose {

/// The comparison's orders by turns of its first angle: amplitude and phase of the first channel in one fit beside the
/// constants of the set-ups, what is stated taken off, what the run leaves free not. Uncertainty: the noise model's,
/// scaled by what the fit leaves over. Not included: what is not harmonic.
std::vector<Harmonic> TabulateOrders(const Compared& compared, const TwinComparison& comparison,
                                     const NoiseModel& noise);

}  // namespace twinbench::diagnose
