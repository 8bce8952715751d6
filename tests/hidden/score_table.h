#pragma once

#include <string>
#include <vector>

#include "tests/hidden/judge.h"
#include "tests/hidden/share.h"

/// Outcomes as tables.
namespace twinbench::hidden {

/// The score in Markdown: by set, by cause, unlisted causes, false alarms by noise, leave-one-out, calibration of
/// the stated probabilities, parameters, gain, times, and a list of the answers that are not right.
std::string ScoreTable(const std::vector<Outcome>& outcomes);

/// One row a case: set, case, truth, rho, grade, answer, probability, alarm_p, parameters with their truth, gain
/// with its interval, seconds.
std::string CasesCsv(const std::vector<Outcome>& outcomes);

}  // namespace twinbench::hidden
