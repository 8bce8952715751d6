#pragma once

#include <vector>

#include "twin/benches/circular_motion/settings.h"
#include "twin/core/frames.h"

namespace twinbench::sim {

/// Where on its circle the machine is told to be, and how it comes there.
struct CircleInstant {
  double commanded_rad = 0.0;  // polar angle
  double radius_m = 0.0;
  int direction = 1;      // +1: counter-clockwise
  double feed_m_s = 0.0;  // 0: at rest
  double above_K = 0.0;   // temperature above that of reference

  double Rate_rad_s() const { return direction * feed_m_s / radius_m; }
  bool SameCourse(const CircleInstant& other) const {
    return commanded_rad == other.commanded_rad && radius_m == other.radius_m && direction == other.direction &&
           feed_m_s == other.feed_m_s;
  }
  /// So much earlier on the same pass.
  CircleInstant Before(double latency_s) const;
};

/// An error that repeats along an axis.
struct CyclicError {
  std::size_t axis;
  double amplitude_m, phase_rad, pitch_m;
};

/// What an axis does behind its reversals.
struct ReversalSpike {
  std::size_t axis;
  double height_m, time_s;
};

/// The machine on a circle, in its steady state.
class CircleMachine {
 public:
  explicit CircleMachine(const CircularMachineSettings& settings);

  void Add(const CyclicError& error) { cyclic_.push_back(error); }
  void Add(const ReversalSpike& spike) { spikes_.push_back(spike); }

  /// Of the spindle relative to the table, from the commanded centre.
  Eigen::Vector2d Position_m(const CircleInstant& at) const;
  /// The same where the axes followed by themselves to `followed_m`: that takes the place of the lagged circle.
  /// When they turned round is told by the lags still.
  Eigen::Vector2d Position_m(const CircleInstant& at, const Eigen::Vector2d& followed_m) const;

 private:
  CircularMachineSettings settings_;
  std::vector<CyclicError> cyclic_;
  std::vector<ReversalSpike> spikes_;
};

}  // namespace twinbench::sim
