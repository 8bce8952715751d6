#pragma once

#include <Eigen/Core>
#include <functional>
#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "mechanics/plant.h"
#include "optics/autocollimator.h"
#include "twin/benches/turntable_autocollimator/twin/effect.h"
#include "twin/benches/turntable_autocollimator/twin/mirror_stand.h"
#include "twin/core/devices.h"
#include "twin/sim/empirical_signal.h"

namespace twinbench::sim {

/// What disturbances add to one reading of the turntable bench.
struct TurntableExtra {
  MirrorExtra mirror;
  double yaw_rad = 0.0;                                 // of the turntable's rotor
  double warmer_K = 0.0;                                // than the thermometer says
  Eigen::Vector2d shown_rad = Eigen::Vector2d::Zero();  // behind the optics
};

/// Images of mirrors that were looked at lately, by reading: most causes move neither the mirror nor the
/// instrument.
class ImagesOnce {
 public:
  /// Pose of the mirror and everything that the optics are made of.
  using Key = Eigen::Matrix<double, 25, 1>;

  optics::AutocollimatorImage Of(int reading, const Key& key,
                                 const std::function<optics::AutocollimatorImage()>& look);

 private:
  std::mutex mutex_;
  std::map<int, std::list<std::pair<Key, optics::AutocollimatorImage>>> seen_;  // the last one first
};

/// The turntable bench between its rotors and what the autocollimator shows, at whatever moment it is asked about:
/// no clock, no drives, no noise. The live bench and the twin that follows a record share it, so that both are one
/// physics.
class MirrorPath {
 public:
  /// @param field_share  Of the stated range in which there is a reading: 1, but for who must not lose one at its
  ///                     edge.
  explicit MirrorPath(const Scenario& nominal, double field_share = 1.0,
                      optics::Fidelity fidelity = optics::Fidelity::kTraced,
                      std::shared_ptr<ImagesOnce> images = nullptr);

  /// The bench as it is, with every effect on its constants.
  const Scenario& actual() const { return actual_; }
  MirrorStand& stand() { return stand_; }
  const MirrorStand& stand() const { return stand_; }

  /// @param above_K    Temperature of the instrument above the one at which it is as stated.
  /// @param noise_rad  Of the camera.
  AutocollimatorReading Look(TurntableMoment moment, const mechanics::StackState& axes, double above_K,
                             const Eigen::Vector2d& noise_rad, const TurntableExtra& extra = {});

 private:
  Eigen::Vector2d Zero_rad(double above_K) const;
  optics::AutocollimatorImage See(int reading, const Pose& X_LM);

  std::vector<std::unique_ptr<TurntableEffect>> effects_;
  Scenario actual_;
  MirrorStand stand_;
  optics::AutocollimatorOptics optics_;
  EmpiricalSignal empirical_x_, empirical_y_;
  std::shared_ptr<ImagesOnce> images_;
};

}  // namespace twinbench::sim
