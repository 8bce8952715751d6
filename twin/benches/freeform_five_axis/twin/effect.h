#pragma once

#include <memory>

#include "twin/benches/freeform_five_axis/twin/chain.h"
#include "twin/benches/freeform_five_axis/twin/probe.h"
#include "twin/sim/effect_makers.h"

namespace twinbench::sim {

/// What the twin of a five-axis machine knows at the instant of a reading.
struct FreeformMoment {
  int reading = 0, setup = 0;
  double time_s = 0.0;
  double run_share = 0.0;  // of the whole run
  double direction = 1.0;
  double above_K = 0.0;
  MachineCommand at{};
  ArtefactCell cell;
};

/// What adds to one reading: errors of the machine and of how the artefact stands, a height of the cell, a way of
/// the spot, and what is shown.
struct FreeformExtra {
  MachineErrors machine;
  BodyError mounting{};
  Vector3 slipped_S_m = Vector3::Zero();  // of the artefact, along the X slide's axes
  double cell_height_m = 0.0;
  Eigen::Vector2d spot_m = Eigen::Vector2d::Zero();
  double qpd_x_V = 0.0, qpd_y_V = 0.0, ccd_px = 0.0;
};

/// One cause on the bench freeform_five_axis. Most have only one of the two parts.
class FreeformEffect {
 public:
  virtual ~FreeformEffect() = default;

  /// Once for each reading, with the time running forwards.
  virtual void Disturb(const FreeformMoment& /*moment*/, FreeformExtra& /*extra*/) {}
  /// What the detectors show without it.
  virtual void AlterSignals(const FreeformMoment& /*moment*/, ProbeSignals& /*shown*/) const {}
};

EffectMakers<FreeformEffect> MachineEffects();   // and of the artefact
EffectMakers<FreeformEffect> DetectorEffects();

}  // namespace twinbench::sim
