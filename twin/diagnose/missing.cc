#include "twin/diagnose/missing.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "twin/core/scenario.h"

namespace twinbench::diagnose {
namespace {

/// An optional column, what a reading has of it, and what is lost where none has.
struct OptionalColumn {
  std::string name;
  std::function<bool(const Reading&)> is_there;
  std::string lost;
  bool calibration_only = false;
};

bool HasScatter(const Reading& r) {
  return r.n_samples > 0 &&
         std::any_of(r.std_V.begin(), r.std_V.end(), [](double std_V) { return std::isfinite(std_V); });
}

std::vector<OptionalColumn> RotaryColumns() {
  return {
      {"dwell_s", [](const Reading& r) { return std::isfinite(r.dwell_s); },
       "settling cannot be named: it looks like backlash"},
      {"temperature_degC", [](const Reading& r) { return std::isfinite(r.temperature_degC); },
       "wavelength_temperature and thermal_tilt cannot be named: they look like laser_drift, mount_creep or "
       "unknown "
       "structure in time"},
      {"n_samples and psd_..._std_V", HasScatter,
       "the noise of a reading is taken from the scenario, so that a wrong noise figure and small structure "
       "without a "
       "name look alike"},
      {"autocollimator_yaw_arcsec and autocollimator_tilt_arcsec",
       [](const Reading& r) {
         return std::isfinite(r.autocollimator_yaw_rad) && std::isfinite(r.autocollimator_tilt_rad);
       },
       "the calibration sweeps are lost, and psd_gain, psd_roll, psd_distance, psd_nonlinearity, stray_light, "
       "wavelength_offset, incidence_offset and crosstalk are hidden in the tables' errors or cannot be told apart",
       true}};
}

std::vector<OptionalColumn> EncoderColumns() {
  return {{"velocity_deg_s", [](const Reading& r) { return std::isfinite(r.velocity_rad_s); },
           "latency is judged by speeds from the reference's own angles and times, and at stops not at all"},
          {"temperature_degC", [](const Reading& r) { return std::isfinite(r.temperature_degC); },
           "a drift cannot be tied to the temperature"}};
}

std::vector<OptionalColumn> TurntableColumns() {
  return {{"dwell_s", [](const Reading& r) { return std::isfinite(r.dwell_s); },
           "settling cannot be named: it looks like backlash"},
          {"temperature_degC", [](const Reading& r) { return std::isfinite(r.temperature_degC); },
           "autocollimator_temperature cannot be named: it looks like autocollimator_drift, mount_creep or unknown "
           "structure in time"},
          {"autocollimator_x_arcsec", [](const Reading& r) { return std::isfinite(r.autocollimator_yaw_rad); },
           "autocollimator_scale and autocollimator_nonlinearity are hidden in the turntable's errors", true}};
}

std::vector<OptionalColumn> HobColumns() {
  return {{"velocity_deg_s", [](const Reading& r) { return std::isfinite(r.velocity_rad_s); },
           "latency is judged by speeds from the table encoder's own angles and times"},
          {"interferometer_arcsec", [](const Reading& r) { return std::isfinite(r.interferometer_rad); },
           "hob_runout and gear_mesh look like eccentricity and ellipticity of the hob's encoder, backlash at one "
           "speed like latency"}};
}

std::vector<OptionalColumn> ColumnsOf(const std::string& bench) {
  if (bench == kHobBench) return HobColumns();
  if (bench == kRotaryBench) return RotaryColumns();
  return bench == kTurntableBench ? TurntableColumns() : EncoderColumns();
}

bool HasPhase(const std::vector<Reading>& readings, Phase phase) {
  return std::any_of(readings.begin(), readings.end(), [&](const Reading& r) { return r.phase == phase; });
}

bool IsMissing(const OptionalColumn& column, const std::vector<Reading>& readings) {
  return std::none_of(readings.begin(), readings.end(), [&](const Reading& r) {
    return (!column.calibration_only || r.phase == Phase::kCalibration) && column.is_there(r);
  });
}

}  // namespace

std::vector<std::string> MissingColumns(const std::vector<Reading>& readings, const std::string& bench) {
  std::vector<std::string> notes;
  for (const OptionalColumn& column : ColumnsOf(bench)) {
    if (!IsMissing(column, readings)) continue;
    const bool no_phase = column.calibration_only && !HasPhase(readings, Phase::kCalibration);
    notes.push_back((no_phase ? "there are no calibration readings: " : "no column " + column.name + ": ") +
                    column.lost);
  }
  return notes;
}

}  // namespace twinbench::diagnose
