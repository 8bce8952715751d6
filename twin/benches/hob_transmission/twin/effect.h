#pragma once

#include <memory>

#include "mechanics/encoder_signal.h"
#include "mechanics/gear_train.h"
#include "twin/core/scenario.h"
#include "twin/core/time.h"

namespace twinbench::sim {

/// What the twin of the hobbing machine knows at the instant of a sample.
struct HobMoment {
  Time now{};
  int reading = 0;
  double table_rad = 0.0;       // of the table, unwrapped
  double velocity_rad_s = 0.0;  // of the table, as commanded
};

/// What is added to what the counters show, and what the table does beyond its gears: its encoder and the
/// interferometer see that. What the interferometer alone shows too much.
struct ShownError {
  double table_rad = 0.0;
  double hob_rad = 0.0;
  double motion_rad = 0.0;
  double interferometer_rad = 0.0;
};

/// One cause on the bench hob_transmission. Errors of different effects add; no effect looks at another one.
class HobEffect {
 public:
  virtual ~HobEffect() = default;

  /// Before anything is built: constants of the bench that are not what the scenario says.
  virtual void AlterBench(Scenario& /*actual*/) const {}
  virtual void AlterGears(mechanics::GearErrors& /*errors*/) const {}
  virtual void AlterHobSignals(mechanics::SignalState& /*signals*/) const {}
  /// The table has come here without turning round.
  virtual void Travel(double /*table_rad*/) {}
  /// Once for each sample, with the time running forwards.
  virtual ShownError Shown(const HobMoment& /*moment*/) { return {}; }
};

/// @param effect  Checked against the catalogue by the scenario loader.
/// @throws std::logic_error if the catalogue has an effect that the twin has not.
std::unique_ptr<HobEffect> MakeHobEffect(const EffectSettings& effect, const Scenario& scenario);

}  // namespace twinbench::sim
