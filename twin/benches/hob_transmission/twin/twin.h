#pragma once

#include <memory>
#include <nlohmann/json_fwd.hpp>

#include "twin/core/machine.h"
#include "twin/core/scenario.h"
#include "twin/model/follow.h"

namespace twinbench::sim {

/// The virtual bench hob_transmission: a transmission chain with ring encoders, a counter card and an
/// interferometer that a procedure can drive, and the truth that it may not see.
///
/// Same scenario, same bits: every random number comes from Stream(scenario.seed, name of its cause).
class HobTwin : public MachineDevices {
 public:
  /// @throws InputError if the machine cannot be built as the scenario says.
  explicit HobTwin(const Scenario& scenario);
  ~HobTwin() override;

  /// One axis that turns on and on, the hob; its place is the one of the last time that anything was asked of the chain.
  MachineBench Devices() override;

  /// {"transmission": [{order, amplitude_arcsec, phase_deg}], "table_encoder": [the same], "effects": [...],
  ///  "seed": n}: harmonics of cosines. The transmission error is quasi-static; the encoder's is that of its
  ///  geometry, in its own angle, with the head at its mark.
  nlohmann::json Truth() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// The hobbing machine's twin on the course of a record. Predictions are two [rad]: what table encoder - ratio x
/// hob encoder should have been with the hob's encoder where the record has it, and what the interferometer should
/// have seen (NaN without one).
///
/// Free, so zero until given at the point "transmission": orders 1 to transmission.free_orders of the transmission
/// error. The chain is quasi-static, as the kinematic train is where the wheel drags the table. Left out: inertia,
/// so what servo and torsion do to harmonics in the fidelity "bullet" (at the line of the worm, at 50 r/min of the
/// hob, 0.2 % of it), and what is left of a play that a ramp did not cross.
std::unique_ptr<model::Follow> FollowHob(const Scenario& scenario, const std::vector<Reading>& record);

}  // namespace twinbench::sim
