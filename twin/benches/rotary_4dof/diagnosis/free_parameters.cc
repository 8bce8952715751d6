#include "twin/benches/rotary_4dof/diagnosis/free_parameters.h"

#include "twin/core/units.h"

namespace twinbench::diagnose::rotary {
namespace {

using separate::Design;
using separate::kLengthUnit_m;
using separate::Series;

constexpr double kTableAngleSd_rad = 500.0 * units::arcsec;
constexpr double kTableLengthSd_m = 0.5 * units::mm;
constexpr double kMountAngleSd_rad = 0.05;
constexpr double kMountLengthSd_m = 10.0 * units::mm;

/// Believed of calibrated parameters once a bench has been set up; they stay this uncertain in the model.
constexpr double kGainSd = 1e-4;
constexpr double kRollSd_rad = 1e-4;
constexpr double kDistanceSd_m = 10e-6;
constexpr double kWavelengthSd_m = 0.05e-9;
constexpr double kIncidenceSd_rad = 1e-4;

/// ez, ex, ey, dy.
Vector4 MountSd() {
  return {kMountAngleSd_rad, kMountAngleSd_rad, kMountAngleSd_rad, kMountLengthSd_m / kLengthUnit_m};
}

/// Two tilts, two eccentricities.
Vector4 SeatSd() {
  constexpr double kLengthSd = kMountLengthSd_m / kLengthUnit_m;
  return {kMountAngleSd_rad, kMountAngleSd_rad, kLengthSd, kLengthSd};
}

void SetTables(const Design& design, Eigen::VectorXd& sd) {
  sd.setConstant(kTableAngleSd_rad);
  for (int i = 0; i < design.n; ++i) {
    for (const Series s : {Series::kTargetDy, Series::kRefDx, Series::kRefDy}) {
      sd[design.Column(s, i)] = kTableLengthSd_m / kLengthUnit_m;
    }
  }
}

void SetMounts(const Design& design, Eigen::VectorXd& sd) {
  for (int s = 0; s < std::ssize(design.setups); ++s) {
    sd.segment<4>(design.MountColumn(s)) = MountSd();
    if (design.setups[static_cast<std::size_t>(s)].clamping == separate::Clamping::kReclamp) continue;
    sd.segment<4>(design.SeatColumn(s)) = SeatSd();
  }
  sd.segment<4>(CalibrationMountColumn(design)) = MountSd();
}

}  // namespace

int CalibrationMountColumn(const Design& design) {
  return design.Unknowns();
}

int CalibratedColumn(const Design& design) {
  return CalibrationMountColumn(design) + separate::kMountUnknowns;
}

int UnknownsOf(const Design& design) {
  return CalibratedColumn(design) + kCalibrated;
}

const std::array<Calibrated, kCalibrated>& CalibratedConstants() {
  static const std::array<Calibrated, kCalibrated> constants = {{
      {{"psd_gain", "psd_a_x", "gain_error"}, kGainSd},
      {{"psd_gain", "psd_a_y", "gain_error"}, kGainSd},
      {{"psd_gain", "psd_b_x", "gain_error"}, kGainSd},
      {{"psd_gain", "psd_b_y", "gain_error"}, kGainSd},
      {{"psd_roll", "psd_a", "roll"}, kRollSd_rad},
      {{"psd_roll", "psd_b", "roll"}, kRollSd_rad},
      {{"psd_distance", "psd_a", "distance_error"}, kDistanceSd_m},
      {{"psd_distance", "psd_b", "distance_error"}, kDistanceSd_m},
      {{"wavelength_offset", "", "wavelength_error"}, kWavelengthSd_m},
      {{"incidence_offset", "", "incidence"}, kIncidenceSd_rad},
  }};
  return constants;
}

Eigen::VectorXd PriorPrecision(const Design& design) {
  Eigen::VectorXd sd(UnknownsOf(design));
  SetTables(design, sd);
  SetMounts(design, sd);
  for (int k = 0; k < kCalibrated; ++k)
    sd[CalibratedColumn(design) + k] = CalibratedConstants()[static_cast<std::size_t>(k)].sd;
  return sd.cwiseAbs2().cwiseInverse();
}

}  // namespace twinbench::diagnose::rotary
