#include <algorithm>
#include <cmath>
#include <map>

#include "twin/benches/turntable_autocollimator/format.h"
#include "twin/core/reading_column.h"
#include "twin/core/units.h"

namespace twinbench::benches::turntable {
namespace {

/// How far `target + sense x reference` wanders within the set-ups, whole turns apart [rad].
double Wander_rad(const std::vector<Reading>& readings, double sense) {
  std::map<int, double> first_rad;
  double widest_rad = 0.0;
  for (const Reading& r : readings) {
    if (r.phase == Phase::kCalibration) continue;  // the turntable moves alone
    const double sum_rad = r.target_rad + sense * r.reference_rad;
    const double start_rad = first_rad.try_emplace(r.setup, sum_rad).first->second;
    widest_rad = std::max(widest_rad, std::abs(std::remainder(sum_rad - start_rad, 2.0 * units::kPi)));
  }
  return widest_rad;
}

}  // namespace

std::vector<ReadingColumn> Columns() {
  std::vector<ReadingColumn> own = {
      NumberColumn(
          "turntable_deg", units::deg, ColumnRole::kRequired, [](auto& r) -> auto& { return r.target_rad; }),
      NumberColumn(
          "multitooth_deg", units::deg, ColumnRole::kRequired, [](auto& r) -> auto& { return r.reference_rad; }),
      ShownColumn(
          "autocollimator_x_arcsec", units::arcsec, "arcsec",
          [](auto& r) -> auto& { return r.autocollimator_yaw_rad; }),
      ShownColumn(
          "autocollimator_y_arcsec", units::arcsec, "arcsec",
          [](auto& r) -> auto& { return r.autocollimator_tilt_rad; })};
  own.back().may_be_absent = true;  // an instrument of one axis has none
  return Joined({CommonColumns(false), own, ConditionColumns()});
}

void CountBothTheSameWay(std::vector<Reading>& readings) {
  constexpr double kNothing_rad = 1e-6;
  if (Wander_rad(readings, 1.0) <= kNothing_rad || Wander_rad(readings, -1.0) > kNothing_rad) return;
  for (Reading& r : readings) r.reference_rad = -r.reference_rad;
}

std::vector<DesiredColumn> Desired() {
  return {{"autocollimator_y_arcsec", [](const Reading& r) { return std::isfinite(r.autocollimator_tilt_rad); },
           "tilts of the mirror are taken for zero: what they make of x with a roll of the crosshair is hidden in the "
           "turntable's errors"},
          {"dwell_s", [](const Reading& r) { return std::isfinite(r.dwell_s); },
           "settling cannot be named: it looks like backlash"},
          {"temperature_degC", [](const Reading& r) { return std::isfinite(r.temperature_degC); },
           "autocollimator_temperature cannot be named: it looks like autocollimator_drift, mount_creep or unknown "
           "structure in time"},
          {"autocollimator_x_arcsec", [](const Reading& r) { return std::isfinite(r.autocollimator_yaw_rad); },
           "autocollimator_scale and autocollimator_nonlinearity are hidden in the turntable's errors", true}};
}

std::string Addition(int /*setups*/) {
  return "a second pass, as in turntable_procedure.passes = [1, -1], which shows drift and backlash; or the circle "
         "again with another tilt, as in turntable_procedure.tilts_arcsec = [60, 100], which shows the roll of the "
         "crosshair";
}

}  // namespace twinbench::benches::turntable
