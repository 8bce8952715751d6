#include "twin/benches/rotary_4dof/twin/optical_path.h"

#include <algorithm>

#include "twin/benches/rotary_4dof/settings.h"

namespace twinbench::sim {

namespace {

/// For which the PSDs were placed. They stand where the nominal grating would send it, whatever the grooves are.
double NominalWavelength_m(const Scenario& nominal, const Scenario& actual) {
  return RotaryOf(nominal).laser.wavelength_m *
         (RotaryOf(nominal).grating.lines_per_m / RotaryOf(actual).grating.lines_per_m);
}

}  // namespace

OpticalPath::OpticalPath(const Scenario& nominal, LightAsked asked)
    : effects_(nominal),
      actual_(effects_.ActualBench(nominal)),
      power_drift_per_s_(RotaryOf(actual_).laser.power_drift_per_s),
      stand_(actual_),
      light_(actual_, NominalWavelength_m(nominal, actual_), asked),
      electronics_(actual_, effects_.Sampling()) {}

Pose GratingPose(const Stand& stand, const ActiveEffects& effects, const Moment& moment,
                 const mechanics::StackState& axes, const PoseState& pose) {
  std::array<double, 2> labels_rad = {moment.target_rad, moment.reference_rad};
  effects.AlterLabels(labels_rad[0], labels_rad[1]);
  return stand.GratingPose(moment, pose, labels_rad, {axes.target_bearing, axes.reference_bearing});
}

Pose OpticalPath::GratingPose(const Moment& moment, const mechanics::StackState& axes) const {
  return sim::GratingPose(stand_, effects_, moment, axes, effects_.Pose(moment));
}

LightState OpticalPath::LightAt(const Moment& moment) const {
  LightState light = light_.Nominal(moment.temperature_K);
  // A laser that has drifted away is dark, not negative.
  light.power_change = std::max(power_drift_per_s_ * ToSeconds(moment.now), 1e-9 - 1.0);
  effects_.AlterLight(moment, light);
  return light;
}

}  // namespace twinbench::sim
