#include "twin/diagnose/missing.h"

#include <algorithm>

#include "twin/core/bench_format.h"

namespace twinbench::diagnose {
namespace {

bool HasPhase(const std::vector<Reading>& readings, Phase phase) {
  return std::any_of(readings.begin(), readings.end(), [&](const Reading& r) { return r.phase == phase; });
}

bool IsMissing(const DesiredColumn& column, const std::vector<Reading>& readings) {
  return std::none_of(readings.begin(), readings.end(), [&](const Reading& r) {
    return (!column.calibration_only || r.phase == Phase::kCalibration) && column.is_there(r);
  });
}

}  // namespace

std::vector<std::string> MissingColumns(const std::vector<Reading>& readings, const std::string& bench) {
  std::vector<std::string> notes;
  for (const DesiredColumn& column : FormatOf(bench).desired) {
    if (!IsMissing(column, readings)) continue;
    const bool no_phase = column.calibration_only && !HasPhase(readings, Phase::kCalibration);
    notes.push_back((no_phase ? "there are no calibration readings: " : "no column " + column.name + ": ") +
                    column.lost);
  }
  return notes;
}

}  // namespace twinbench::diagnose
