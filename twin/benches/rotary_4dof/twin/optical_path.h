#pragma once

#include "mechanics/plant.h"
#include "twin/benches/rotary_4dof/twin/effects_active.h"
#include "twin/benches/rotary_4dof/twin/electronics.h"
#include "twin/benches/rotary_4dof/twin/light.h"
#include "twin/benches/rotary_4dof/twin/stand.h"

namespace twinbench::sim {

/// The rotary bench between its rotors and the A/D's codes, at whatever moment it is asked about: no clock, no
/// drives. The live bench and the twin that follows a record share it, so that both are one physics.
class OpticalPath {
 public:
  explicit OpticalPath(const Scenario& nominal, LightAsked asked = LightAsked::kAsStated);

  /// The bench as it is, with every effect on its constants.
  const Scenario& actual() const { return actual_; }
  ActiveEffects& effects() { return effects_; }
  const ActiveEffects& effects() const { return effects_; }
  Stand& stand() { return stand_; }
  const Stand& stand() const { return stand_; }
  const Light& light() const { return light_; }
  Electronics& electronics() { return electronics_; }
  const Electronics& electronics() const { return electronics_; }

  /// X_LG at a moment, effects included.
  Pose GratingPose(const Moment& moment, const mechanics::StackState& axes) const;
  LightState LightAt(const Moment& moment) const;

 private:
  ActiveEffects effects_;
  Scenario actual_;
  double power_drift_per_s_;
  Stand stand_;
  Light light_;
  Electronics electronics_;
};

/// X_LG where the stand's rotors are at the moment's angles and everything in `pose` comes on top.
Pose GratingPose(const Stand& stand, const ActiveEffects& effects, const Moment& moment,
                 const mechanics::StackState& axes, const PoseState& pose);

}  // namespace twinbench::sim
