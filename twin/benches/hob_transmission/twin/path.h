#pragma once

#include <memory>
#include <vector>

#include "mechanics/encoder_signal.h"
#include "mechanics/gear_train.h"
#include "twin/benches/hob_transmission/twin/counter_samples.h"
#include "twin/benches/hob_transmission/twin/effect.h"
#include "twin/sim/empirical_signal.h"

namespace twinbench::sim {

/// The hobbing machine as its scenario and effects make it, at whatever moment it is asked about: no clock, no
/// noise. The live machine and the twin that follows a record share it, so that both are one physics.
class HobPath {
 public:
  explicit HobPath(const Scenario& nominal);

  /// The bench as it is, with every effect on its constants.
  const Scenario& actual() const { return actual_; }
  const mechanics::GearTrainParameters& train() const { return train_; }
  mechanics::SignalState HobSignals() const;

  /// What the interferometer shows of the table's deviation from the ratio, with its own cosine, arm, dead path,
  /// air and calibrator; NaN without one, and in motion where it is read at rest.
  double Interferometer_rad(double table_rad, double hob_rad, double velocity_rad_s, Time now) const;

  /// The table has come here without turning round.
  void Travel(double table_rad);
  /// Adds what effects and [[empirical]] signals do to a sample, with the time running forwards.
  void Disturb(const HobMoment& moment, CounterSample& sample);

  /// Of the gears, by turns of the table: what the chain would err if it ran infinitely slowly.
  std::vector<mechanics::AngleHarmonic> Transmission() const;
  /// By which the gears are ahead of the table that they drag: half of the backlash, and wind-up. They err by their own angle.
  double GearsAhead_rad() const { return 0.5 * train_.backlash_rad + train_.friction.coulomb_Nm / train_.stiffness_Nm_rad; }

 private:
  std::vector<std::unique_ptr<HobEffect>> effects_;
  Scenario actual_;
  mechanics::GearTrainParameters train_;
  EmpiricalSignal empirical_;
  std::vector<mechanics::AngleHarmonic> calibrator_;
};

}  // namespace twinbench::sim
