#pragma once

#include <memory>
#include <vector>

#include "twin/benches/turntable_autocollimator/diagnosis/turntable_run.h"
#include "twin/diagnose/engine/candidates.h"

/// What the makers of families have in common; only they need it.
namespace twinbench::diagnose::turntable {

using Context = std::shared_ptr<const SignalContext>;

/// Every effect of the catalogue that leaves a trace.
/// @param sigma_rad  Usual noise of a reading.
std::vector<Family> NamedFamilies(const Context& context, double sigma_rad, const TimeSeries& series);

/// Structure without a name.
std::vector<Family> UnknownFamilies(const TurntableRun& turntable, const TimeSeries& series);

}  // namespace twinbench::diagnose::turntable
