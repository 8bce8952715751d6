#pragma once

#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "twin/benches/freeform_five_axis/twin/effect.h"
#include "twin/benches/freeform_five_axis/twin/light.h"
#include "twin/core/reading.h"
#include "twin/core/scenario.h"
#include "twin/model/follow.h"
#include "twin/sim/driven_machine.h"
#include "twin/sim/empirical_signal.h"

namespace twinbench::sim {

/// The machine and the mountings as they really are: what the scenario says, and what it lets be drawn.
struct DrawnBench {
  MachineSettings machine;
  std::vector<BodyError> mountings;  // one a set-up
};
DrawnBench Draw(const Scenario& scenario);

/// The virtual five-axis machine with its probe and artefact, and the scenario's effects. Readings are asked for in
/// their order.
class FreeformTwin {
 public:
  /// @param drawn  Nothing drawn: the machine is as the scenario says and every set-up stands where it should.
  FreeformTwin(const Scenario& scenario, DrawnBench drawn, LightAsked asked = LightAsked::kAsStated);

  /// Without noise. Where no light comes to the camera ccd_px is NaN.
  /// @param reading  With its commanded values; without a temperature it is at reference.
  /// @param run_share  Of the whole run.
  ProbeSignals Show(const Reading& reading, double run_share, FreeformExtra extra = {});

  const DrawnBench& drawn() const { return drawn_; }
  const ProbeLight& light() const { return *light_; }

 private:
  Scenario scenario_;
  FreeformSettings actual_;
  DrawnBench drawn_;
  std::unique_ptr<ProbeLight> light_;
  std::vector<std::unique_ptr<FreeformEffect>> effects_;
  std::vector<EmpiricalSignal> empirical_;
};

/// {"machine": {"errors": {"x.tx": {"unit", "coefficients"}, ...}, "squareness_arcsec": {...}}, "mountings": [...],
/// "effects": [...], "seed": n}
nlohmann::json FreeformTruth(const Scenario& scenario, const DrawnBench& drawn);

/// Points: every error of the machine ("x.tx" ... "b.rz", "syx" ... "sbz"), how the artefact stands ("mount.tx" ...
/// "mount.rz"), the spot on the quadrant detector, the height of the surface, and the channels.
std::unique_ptr<model::Follow> FollowFreeform(const Scenario& scenario, const std::vector<Reading>& record);

/// The five-axis machine with its probe, to be driven. The probe looks at the cell that its plan says, or beside
/// the plan at the one under its beam.
std::unique_ptr<DrivenPhysics> MakeFreeformPhysics(const Scenario& scenario);

}  // namespace twinbench::sim
