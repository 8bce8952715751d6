#pragma once

#include <memory>
#include <nlohmann/json.hpp>
#include <vector>

#include "twin/core/devices.h"
#include "twin/sim/encoder/effect.h"

namespace twinbench::sim {

/// The virtual angle comparison: an ideal device and an ideal reference on one shaft, with the scenario's effects.
///
/// Same scenario, same bits; the noise of a reading follows from its number alone.
class EncoderTwin : public AngleComparator {
 public:
  /// @throws InputError if an effect needs what the scenario does not state.
  explicit EncoderTwin(const Scenario& scenario);

  void Take(Reading& reading) override;

  /// {"effects": [...], "seed": n}: opened only by tests and scores.
  nlohmann::json Truth() const;

 private:
  double DeviceAngle_rad(const AngleMoment& moment);
  double Empirical_rad(int reading) const;

  Scenario scenario_;
  std::vector<std::unique_ptr<AngleEffect>> effects_;
  SignalState signals_;
  std::map<int, double> empirical_rad_;  // by reading
};

}  // namespace twinbench::sim
