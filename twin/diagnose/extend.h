#pragma once

#include <string>

#include "twin/diagnose/diagnose.h"

namespace twinbench::diagnose {

/// The scenario with what the diagnosis found: an [[effect]] block for every cause at work, with value,
/// uncertainty, evidence and `provenance` (of a tie the one that the search took in); for structure without a name
/// an [[empirical]] block a channel. The twin runs it. A cause of which no size was fitted is left out.
///
/// Values are those of the cause in the diagnosis. A value outside the catalogue's bounds is moved to the bound, so
/// that the scenario can be read; the diagnosis itself keeps what was fitted. Empirical signals below a nanometre
/// (or a nanoradian) everywhere on a channel are left out, others are rounded to a hundredth of that.
///
/// @param provenance  Which run said so, and when.
Scenario Extend(const Scenario& scenario, const DiagnosisRun& run, const std::string& provenance);

/// The cause as a twin carries it out: its parameters where they were estimated and within the catalogue's bounds,
/// the others as the catalogue has them.
EffectSettings EffectOf(const Cause& cause, const std::string& bench, const std::string& provenance);

/// The extended scenario has this structure without a name only at the readings that showed it: no signal of a twin
/// has its shape, and it goes by more than time.
bool IsRepeatedOnly(const Accepted& accepted, const LinearRun& run);

/// Whether it becomes a table of this run, by reading or by time: it says nothing of another run.
bool IsTabulated(const Accepted& accepted, const LinearRun& run);

/// Whether any parameter of a cause that has some was fitted: else only the catalogue's values could be written.
bool HasFittedSize(const Cause& cause, const std::string& bench);

/// Extend() as TOML, below a comment that says in a line or two what was added. What the search found is left out if it does not
/// predict readings better that it was not fitted to (Gain::positive).
std::string ExtendedToml(const Scenario& scenario, const DiagnosisRun& run, const std::string& provenance);

}  // namespace twinbench::diagnose
