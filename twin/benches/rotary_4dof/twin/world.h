#pragma once

#include <optional>

#include "twin/benches/rotary_4dof/twin/moving_air.h"
#include "twin/benches/rotary_4dof/twin/optical_path.h"
#include "twin/sim/axes.h"
#include "twin/sim/block_course.h"
#include "twin/sim/environment.h"

namespace twinbench::sim {

/// The whole bench at the time of its event queue. Devices are thin: they ask and change this.
class World {
 public:
  explicit World(const Scenario& nominal);

  EventQueue& queue() { return queue_; }
  Environment& environment() { return environment_; }
  const Scenario& actual() const { return path_.actual(); }

  void StartMove(mechanics::Axis axis, double to_rad);
  bool Settles(mechanics::Axis axis, Duration within) { return axes_.Settles(axis, within); }
  void Stop(mechanics::Axis axis) { axes_.Stop(axis); }
  TableState StateOf(mechanics::Axis axis);
  void Mount(int setup, double clamp_rad, double reseat_rad);
  void SetGoniometer(double yaw_rad, double tilt_rad) { path_.stand().SetGoniometer(yaw_rad, tilt_rad); }

  /// X_LG now, effects included.
  Pose GratingPose();

  /// Takes one block: light and motion are followed while the clock runs to its end, as closely as the fastest
  /// thing that is going on needs. A spot that is lost on the way loses the block.
  Acquisition Acquire(int n_samples, bool keep_raw);

  /// Pictures of both PSDs as the light falls now.
  void WriteIrradiance(const std::string& path);

  const Stand& stand() const { return path_.stand(); }
  const Light& light() const { return path_.light(); }

  /// Events that each device has scheduled.
  const std::map<std::string, std::uint64_t>& Scheduled() const { return queue_.Scheduled(); }

 private:
  /// What reached the converter, and how the light fell at the block's begin or where it was lost.
  struct Followed {
    std::optional<BlockCourse> before;
    BlockCourse course;
    Spots seen;
  };

  Moment Look(const mechanics::StackState& axes);
  double Shortest_s();
  Spots SpotsNow(const Moment& moment, const mechanics::StackState& axes);
  BlockCourse::Voltages SignalOf(const Spots& spots, const Moment& moment);
  Spots AddKnot(BlockCourse& course);
  std::optional<BlockCourse> Before();
  Acquisition Converted(Followed block, Time start, int n_samples, bool keep_raw);

  EventQueue queue_;
  Schedule adc_{queue_, "adc"}, fixture_{queue_, "fixture"};
  OpticalPath path_;
  Environment environment_;
  MovingAir air_;
  Axes axes_;
  Time mounted_{};
  int setup_ = 0;
  int next_reading_ = 0;
};

}  // namespace twinbench::sim
