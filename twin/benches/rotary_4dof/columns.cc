#include "twin/benches/rotary_4dof/columns.h"

#include <algorithm>
#include <cmath>

#include "twin/benches/rotary_4dof/format.h"
#include "twin/core/reading_column.h"
#include "twin/core/units.h"

namespace twinbench::benches::rotary {
namespace {

/// A voltage may be empty: the reading's status says why.
std::vector<ReadingColumn> Voltages() {
  std::vector<ReadingColumn> columns;
  for (std::size_t i = 0; i < kChannels; ++i) {
    columns.push_back(ShownColumn(
        std::string(kChannelNames[i]) + "_V", 1.0, "V", [i](auto& r) -> auto& { return r.mean_V[i]; }));
  }
  for (std::size_t i = 0; i < kChannels; ++i) {
    columns.push_back(NumberColumn(
        std::string(kChannelNames[i]) + "_std_V", 1.0,
        ColumnRole::kShownToo, [i](auto& r) -> auto& { return r.std_V[i]; }));
  }
  return columns;
}

/// In the place of the voltages; written only where they were read.
std::vector<ReadingColumn> Probes() {
  std::vector<ReadingColumn> columns;
  const auto add = [&columns](const Quantity& field, double to_SI) {
    columns.push_back(NumberColumn(field.column, to_SI, ColumnRole::kShownToo, field));
    columns.back().may_be_absent = true;
  };
  for (int probe = 0; probe < kMostProbes; ++probe) add(ProbeRadial_m(probe), units::um);
  add(kProbeAxial_m, units::um);
  add(kProbeTiltX_rad, units::arcsec);
  add(kProbeTiltY_rad, units::arcsec);
  return columns;
}

bool HasScatter(const Reading& r) {
  return r.n_samples > 0 &&
         std::any_of(r.std_V.begin(), r.std_V.end(), [](double std_V) { return std::isfinite(std_V); });
}

}  // namespace

bool ShowsProbes(const std::vector<Reading>& readings) {
  return std::ranges::any_of(readings, [](const Reading& r) {
    return std::ranges::any_of(r.quantities,
                               [](const auto& q) { return q.first.starts_with("probe_") && std::isfinite(q.second); });
  });
}

std::vector<ReadingColumn> Columns() {
  const std::vector<ReadingColumn> commanded = {
      NumberColumn(
          "target_deg", units::deg, ColumnRole::kRequired, [](auto& r) -> auto& { return r.target_rad; }),
      NumberColumn(
          "reference_deg", units::deg, ColumnRole::kRequired, [](auto& r) -> auto& { return r.reference_rad; })};
  const std::vector<ReadingColumn> autocollimator = {
      NumberColumn(
          "autocollimator_yaw_arcsec", units::arcsec, ColumnRole::kOptional,
          [](auto& r) -> auto& { return r.autocollimator_yaw_rad; }),
      NumberColumn(
          "autocollimator_tilt_arcsec", units::arcsec, ColumnRole::kOptional,
          [](auto& r) -> auto& { return r.autocollimator_tilt_rad; })};
  return Joined({CommonColumns(false), commanded, Voltages(), Probes(), ConditionColumns(), autocollimator});
}

std::vector<DesiredColumn> Desired() {
  return {
      {"dwell_s", [](const Reading& r) { return std::isfinite(r.dwell_s); },
       "settling cannot be named: it looks like backlash"},
      {"temperature_degC", [](const Reading& r) { return std::isfinite(r.temperature_degC); },
       "wavelength_temperature, thermal_tilt and post_growth cannot be named: they look like laser_drift, "
       "mount_creep or an unmodelled effect in time"},
      {"n_samples and psd_..._std_V", HasScatter,
       "the noise of a reading is taken from the scenario, so that a wrong noise figure and small structure "
       "that are not in the catalogue look alike"},
      {"autocollimator_yaw_arcsec and autocollimator_tilt_arcsec",
       [](const Reading& r) {
         return std::isfinite(r.autocollimator_yaw_rad) && std::isfinite(r.autocollimator_tilt_rad);
       },
       "the calibration sweeps are lost, and psd_gain, psd_roll, psd_distance, psd_nonlinearity, stray_light, "
       "background, wavelength_offset, incidence_offset and crosstalk are hidden in the tables' errors or not "
       "separable",
       true}};
}

/// One more set-up costs one pass; a second pass in every set-up costs as many as there are set-ups, but shows what
/// depends on time and direction.
std::string Addition(int setups) {
  const std::string passes =
      "passes + - - + in every mounting (procedure.passes = [1, -1, -1, 1]), which also show drift and backlash";
  if (setups >= 3) return passes;
  return std::string("at least a ") + (setups == 1 ? "second" : "third") +
         " mounting with another shift, as in procedure.shifts = " + (setups == 1 ? "[0, 1]" : "[0, 1, 7]") +
         "; better, " + passes;
}

}  // namespace twinbench::benches::rotary
