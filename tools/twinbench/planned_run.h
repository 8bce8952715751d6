#pragma once

#include <string>
#include <vector>

#include "tools/twinbench/patience.h"
#include "twin/core/reading.h"
#include "twin/core/scenario.h"
#include "twin/diagnose/diagnose.h"
#include "twin/plan/unseen.h"
#include "twin/report/plan_text.h"

namespace twinbench::tools {

/// A step of a plan (Patience): one run weighed against the catalogue.
inline constexpr const char* kTellingOfCauses = "what another run would tell of causes";

/// The scenario with the quickest twin that takes the same readings, where the bench has a choice: what differs is
/// below the noise.
Scenario Quick(const Scenario& scenario);

/// Of one run of the quickest twin: what the scenario's run states, but for the noise that it finds in its own readings.
/// @throws InputError if the readings cannot be evaluated.
plan::Outlook OutlookAtOnce(const Scenario& scenario);

/// The scenario's own run, and the mean of its uncertainties over runs with other noise where they depend on it.
/// @param own  OutlookAtOnce of it.
report::PlannedRun OwnRun(const Scenario& scenario, const plan::Outlook& own, Patience& patience);

/// What readings of that design could tell of causes (DiagnosisRun::isolability).
/// @throws InputError as a diagnosis does, and for more than 20 000 readings.
diagnose::DiagnosisRun SeenBy(const Scenario& scenario, const std::vector<Reading>& readings);

/// The same over runs under other chance: what a cause that goes with the room's temperature looks like depends on the
/// course that the room takes.
diagnose::DiagnosisRun SeenUnderChance(const Scenario& scenario, const std::vector<Reading>& readings, Patience& patience);

/// All that such a run would show of causes, but what they move unseen; why not, where its design has no redundancy.
report::PlannedEffects EffectsIn(const Scenario& scenario, const std::vector<Reading>& readings, Patience& patience);

/// Each cause in the smallest size that would be found, carried out on the twin, and what that moves: the same
/// noise in both runs. A cause that the quick twin does not show is asked of the scenario's own.
std::vector<plan::Unseen> UnseenEffects(const Scenario& scenario, const diagnose::DiagnosisRun& seen, Patience& patience);

}  // namespace twinbench::tools
