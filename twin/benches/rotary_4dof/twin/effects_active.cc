#include "twin/benches/rotary_4dof/twin/effects_active.h"

#include <algorithm>

#include "twin/benches/rotary_4dof/settings.h"
#include "twin/sim/actual_bench.h"

namespace twinbench::sim {
namespace {

void SilenceRotary(RotarySettings& own) {
  own.amplifier.noise_V = own.amplifier.flicker_V = 0.0;
  own.adc.lost_fraction = 0.0;
  own.laser.rin_dB_Hz = 0.0;
  own.optics.wander_rad = 0.0;
  own.autocollimator.noise_rad = 0.0;
  Silence(own.target);
  Silence(own.reference);
  Silence(own.mechanics);
}

}  // namespace

ActiveEffects::ActiveEffects(const Scenario& scenario) {
  static const EffectMakers<Effect> makers = Merged(PoseEffects(), SignalEffects());
  for (const EffectSettings& settings : BeyondKeys(scenario))
    effects_.push_back(MakeBy(makers, settings, scenario));
  for (const EmpiricalSettings& settings : scenario.empiricals)
    effects_.push_back(MakeEmpirical(settings, scenario));
}

Scenario ActiveEffects::ActualBench(const Scenario& nominal) const {
  return ActualBenchOf(nominal, effects_, SilenceRotary);
}

double ActiveEffects::Shortest_s() const {
  double shortest_s = std::numeric_limits<double>::infinity();
  for (const auto& effect : effects_) shortest_s = std::min(shortest_s, effect->Shortest_s());
  return shortest_s;
}

void ActiveEffects::Advance(const Moment& moment) {
  for (const auto& effect : effects_) effect->Advance(moment);
}

Mounting ActiveEffects::Actual(Mounting nominal) const {
  for (const auto& effect : effects_) effect->AlterMounting(nominal);
  return nominal;
}

PoseState ActiveEffects::Pose(const Moment& moment) const {
  PoseState pose;
  for (const auto& effect : effects_) effect->AlterPose(moment, pose);
  return pose;
}

void ActiveEffects::AlterLabels(double& target_rad, double& reference_rad) const {
  for (const auto& effect : effects_) effect->AlterLabels(target_rad, reference_rad);
}

void ActiveEffects::AlterLight(const Moment& moment, LightState& light) const {
  for (const auto& effect : effects_) effect->AlterLight(moment, light);
}

std::array<double, kChannels> ActiveEffects::Shown_V(const Moment& moment,
                                                     const std::array<double, kChannels>& spots_V) const {
  std::array<double, kChannels> shown_V = spots_V;
  for (const auto& effect : effects_) {
    for (int c = 0; c < kChannels; ++c)
      shown_V[static_cast<std::size_t>(c)] += effect->AddedToShown_V(moment, spots_V, c);
  }
  return shown_V;
}

void ActiveEffects::AlterSignal(const Moment& moment, std::array<double, kChannels>& signal_V) {
  for (const auto& effect : effects_) effect->AlterSignal(moment, signal_V);
}

SamplingState ActiveEffects::Sampling() const {
  SamplingState sampling;
  for (const auto& effect : effects_) effect->AlterSampling(sampling);
  return sampling;
}

void ActiveEffects::AlterReadout(Acquisition& block) const {
  for (const auto& effect : effects_) effect->AlterReadout(block);
}

}  // namespace twinbench::sim
