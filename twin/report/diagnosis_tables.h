#pragma once

#include <string>

#include "twin/diagnose/diagnose.h"
#include "twin/diagnose/shown.h"

namespace twinbench::report {

inline constexpr std::size_t kPageWidth = 80;

/// Name and place, what it is, each parameter, probability, share; "" without causes. What stands for one cause
/// that the readings cannot tell from it begins with "or".
std::string CauseTable(const diagnose::DiagnosisRun& found, const diagnose::Shown& shown);

/// What to measure next; each measurement once. "" if nothing is needed.
std::string NextMeasurements(const diagnose::Diagnosis& diagnosis);

/// Orders of the error.
/// @param all  Those as well that noise alone may give.
/// @return "" if there is none to show.
std::string HarmonicsTable(const diagnose::DiagnosisRun& found, bool all);

/// What would have been seen, and how large it had to be.
std::string DetectableTable(const diagnose::Diagnosis& diagnosis);

/// What this run cannot see, and which result that may bias.
std::string InvisibleTable(const diagnose::Diagnosis& diagnosis);

}  // namespace twinbench::report
