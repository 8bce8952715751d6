#pragma once

#include <memory>
#include <vector>

#include "twin/benches/rotary_4dof/twin/effect.h"

namespace twinbench::sim {

/// The effects that a scenario switches on, in the order of its blocks. Each call asks all of them in turn.
class ActiveEffects {
 public:
  explicit ActiveEffects(const Scenario& scenario);

  /// The bench as it really is: the scenario's constants with every effect on them, and without any random part if
  /// it says noise_free.
  Scenario ActualBench(const Scenario& nominal) const;

  /// Of the fastest of them.
  double Shortest_s() const;
  void Advance(const Moment& moment);
  Mounting Actual(Mounting nominal) const;
  PoseState Pose(const Moment& moment) const;
  void AlterLabels(double& target_rad, double& reference_rad) const;
  void AlterLight(const Moment& moment, LightState& light) const;
  /// The voltages of the spots with what depends on them.
  std::array<double, kChannels> Shown_V(const Moment& moment, const std::array<double, kChannels>& spots_V) const;
  void AlterSignal(const Moment& moment, std::array<double, kChannels>& signal_V);
  SamplingState Sampling() const;
  void AlterReadout(Acquisition& block) const;

 private:
  std::vector<std::unique_ptr<Effect>> effects_;
};

}  // namespace twinbench::sim
