#pragma once

#include <Eigen/Core>
#include <memory>

#include "twin/core/scenario.h"
#include "twin/core/time.h"

namespace twinbench::sim {

/// What the twin of the turntable bench knows at the instant of a reading.
struct TurntableMoment {
  Time now{};
  Time mounted{};  // when the set-up was made
  Time arrived{};  // when the turntable's last move ended
  int setup = 0;
  int reading = 0;
  int direction = 1;  // of the turntable's last move
  // Filled in where the mirror is looked at: angles of the turntable and of the multi-tooth table, temperature
  // above the reference.
  double turntable_rad = 0.0, multitooth_rad = 0.0, above_K = 0.0;
};

/// One cause on the bench turntable_autocollimator. Errors of different effects add; no effect looks at another
/// one.
class TurntableEffect {
 public:
  virtual ~TurntableEffect() = default;

  /// Before anything is built: constants of the bench that are not what the scenario says.
  virtual void AlterBench(Scenario& /*actual*/) const {}
  /// Of the turntable, beyond its errors.
  virtual double Yaw_rad(const TurntableMoment& /*moment*/) const { return 0.0; }
  /// What is added to the reading (x, y), given the one without it.
  virtual Eigen::Vector2d ReadingError_rad(const TurntableMoment& /*moment*/,
                                           const Eigen::Vector2d& /*reading_rad*/) const {
    return Eigen::Vector2d::Zero();
  }
};

/// @param effect  Checked against the catalogue by the scenario loader.
/// @throws std::logic_error if the catalogue has an effect that the twin has not.
std::unique_ptr<TurntableEffect> MakeTurntableEffect(const EffectSettings& effect, const Scenario& scenario);

}  // namespace twinbench::sim
