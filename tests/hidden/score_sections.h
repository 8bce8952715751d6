#pragma once

#include <string>

#include "tests/hidden/outcome_groups.h"

/// The sections of the score in Markdown, each with its heading; all but the last end with an empty line.
namespace twinbench::hidden {

// score_detection.cc
std::string SetSection(const Outcomes& all);
std::string EffectSection(const Outcomes& all);
std::string RhoSection(const Outcomes& all);

// score_unlisted.cc
std::string UnlistedSection(const Outcomes& all);
std::string LeaveOneOutSection(const Outcomes& all);

// One file each: score_alarms.cc, ..., score_cases.cc
std::string AlarmSection(const Outcomes& all);
std::string CalibrationSection(const Outcomes& all);
std::string SizeSection(const Outcomes& all);
std::string GainSection(const Outcomes& all);
std::string TimeSection(const Outcomes& all);
std::string FailureSection(const Outcomes& all);

}  // namespace twinbench::hidden
