#pragma once

#include <memory>
#include <string>
#include <vector>

#include "twin/benches/turntable_autocollimator/diagnosis/turntable_run.h"
#include "twin/diagnose/engine/family.h"

/// Candidates for a turntable under an autocollimator: every effect of the catalogue that leaves a trace in
/// readings, and generic shapes for what the catalogue has not.
namespace twinbench::diagnose::turntable {

/// Named families, then unknown ones; they own what they need.
///
/// Left out are causes that this run cannot show at all: a temperature that was not recorded, dwells that were not.
/// What it can hardly show is there and comes out as invisible. Backlash, and settling with one dwell, have the
/// same columns and the same prior: they tie. multitooth_seating and outliers are no signatures but matters of the
/// noise (seating.h).
///
/// Prior sizes: the catalogue's defaults; up to ten times as much where those would leave no trace.
///
/// @param excluded  Effects taken out of the catalogue. The unknown ones are the same whatever is excluded.
std::vector<Family> Families(const TurntableRun& turntable, const std::vector<std::string>& excluded = {});

}  // namespace twinbench::diagnose::turntable
