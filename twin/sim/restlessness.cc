#include "twin/sim/restlessness.h"

#include <algorithm>

namespace twinbench::sim {

std::vector<VibrationBand> VibrationOf(const MechanicsSettings& m) {
  std::vector<VibrationBand> bands;
  if (m.vibration == "none") return bands;
  if (m.vibration == "auto") return m.fidelity == "bullet" ? VibrationCriterion("VC-E") : bands;
  if (m.vibration != "listed") return VibrationCriterion(m.vibration);
  for (std::size_t i = 0; i < m.vibration_frequency_Hz.size(); ++i) {
    bands.push_back({m.vibration_frequency_Hz[i], m.vibration_velocity_m_s[i]});
  }
  return bands;
}

Restlessness::Restlessness(const MechanicsSettings& m, const mechanics::StackParameters& parameters,
                           std::uint64_t seed) {
  const std::array<std::string, 2> names = {"target", "reference"};
  for (std::size_t i = 0; i < 2; ++i) {
    const AsynchronousSettings bearing = {m.asynchronous_radial_m[i], m.asynchronous_axial_m[i],
                                          m.asynchronous_tilt_rad[i]};
    if (bearing.radial_m > 0.0 || bearing.axial_m > 0.0 || bearing.tilt_rad > 0.0)
      bearings_[i].emplace(bearing, seed, names[i]);
  }
  const std::vector<VibrationBand> bands = VibrationOf(m);
  if (bands.empty()) return;
  const BaseVibration vibration(bands, seed);
  shaken_.emplace(parameters, vibration);
  for (const BaseVibration::Line& line : vibration.lines())
    shortest_s_ = std::min(shortest_s_, 1.0 / line.frequency_Hz);
}

void Restlessness::AddTo(mechanics::StackState& state, Time time) {
  if (bearings_[0]) state.target_bearing = state.target_bearing + bearings_[0]->At(state.target_rad);
  if (bearings_[1]) state.reference_bearing = state.reference_bearing + bearings_[1]->At(state.reference_rad);
  if (shaken_) shaken_->AddTo(state, time);
}

void Restlessness::Mount(const mechanics::ChainGeometry& geometry) {
  if (shaken_) shaken_->Mount(geometry);
}

}  // namespace twinbench::sim
