#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "twin/core/shared_settings.h"
#include "twin/sim/asynchronous_motion.h"
#include "twin/sim/base_vibration.h"

namespace twinbench::sim {

/// The floor's spectrum that [mechanics] asks for; none if nothing shakes.
std::vector<VibrationBand> VibrationOf(const MechanicsSettings& mechanics);

/// What stirs the stack by chance, at rest and in motion, whatever the fidelity: the vibration of its base and the
/// asynchronous motion of its bearings. Asked at any time, in any order.
class Restlessness {
 public:
  Restlessness(const MechanicsSettings& mechanics, const mechanics::StackParameters& parameters,
               std::uint64_t seed);

  void AddTo(mechanics::StackState& state, Time time);
  /// Period of the floor's fastest line; infinite if it stands still.
  double Shortest_s() const { return shortest_s_; }
  void Mount(const mechanics::ChainGeometry& geometry);

 private:
  std::array<std::optional<AsynchronousMotion>, 2> bearings_;
  std::optional<ShakenStack> shaken_;
  double shortest_s_ = std::numeric_limits<double>::infinity();
};

}  // namespace twinbench::sim
