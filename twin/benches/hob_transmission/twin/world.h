#pragma once

#include <memory>
#include <vector>

#include "twin/benches/hob_transmission/twin/counters.h"
#include "twin/benches/hob_transmission/twin/path.h"
#include "twin/sim/schedule.h"

namespace twinbench::sim {

/// The whole hobbing machine at one time. It runs in pieces short against anything that happens in it; edges of the
/// table's encoder are found between their ends. While it stands still only the clock goes on.
class HobWorld {
 public:
  explicit HobWorld(const Scenario& nominal);

  Time Now() const { return queue_.Now(); }
  /// Events that each device has scheduled.
  const std::map<std::string, std::uint64_t>& Scheduled() const { return queue_.Scheduled(); }
  void RunUntil(Time until);

  void Run(double hob_speed_rad_s, Duration ramp);
  void Mount(double head_rad);
  void Arm(int edges, int samples);
  CounterSamples ReadCounters() { return counters_.Empty(); }
  CounterSample Latch();

  double Hob_rad() const { return train_->State().hob_rad; }
  /// Whether the drive was told a speed.
  bool Turns() const { return hob_speed_rad_s_ != 0.0; }
  bool Moves() const { return Turns() || Now() < slowed_down_; }
  Time SlowedDown() const { return slowed_down_; }

  const Scenario& actual() const { return path_.actual(); }
  const Counters& counters() const { return counters_; }
  /// Of the gears, by turns of the table: what the chain would err if it ran infinitely slowly.
  std::vector<mechanics::AngleHarmonic> Transmission() const { return path_.Transmission(); }
  double GearsAhead_rad() const { return path_.GearsAhead_rad(); }

 private:
  void TakeSamples(const mechanics::GearTrainState& before, const mechanics::GearTrainState& after, Time begin);
  CounterSample SampleAt(const mechanics::GearTrainState& at, Time now);
  /// What the counts do not say: time, speed, the interferometer, and what disturbs all of them.
  CounterSample Completed(CounterSample sample, const mechanics::GearTrainState& at, Time now);
  bool StandsStill() const { return hob_speed_rad_s_ == 0.0 && Now() >= at_rest_; }
  /// Until when nothing need be looked at, `end` at most.
  Duration PieceTo(Time end) const;
  void Pass(Duration piece);
  double Interferometer_rad(const mechanics::GearTrainState& at, double velocity_rad_s, Time now);

  EventQueue queue_;
  Schedule drive_{queue_, "drive"}, card_{queue_, "counters"}, fixture_{queue_, "fixture"};
  HobPath path_;
  std::unique_ptr<mechanics::GearTrain> train_;
  Counters counters_;
  Stream interferometer_noise_;
  Duration piece_{};  // of time, at the present speed
  Time slowed_down_{};  // the last change of speed has ended
  Time at_rest_{};  // from then on nothing moves, unless the drive is told to
  double hob_speed_rad_s_ = 0.0;
  int direction_ = 1;
  int next_reading_ = 0;
};

}  // namespace twinbench::sim
