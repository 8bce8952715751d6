#pragma once

#include <deque>

#include "mechanics/gear_train.h"
#include "twin/benches/hob_transmission/twin/counter_samples.h"
#include "twin/benches/hob_transmission/twin/encoders.h"
#include "twin/core/stream.h"

namespace twinbench::sim {

/// Both ring encoders, the counter card and its FIFO.
///
/// The card looks at falling edges of the table's square wave, one a line, and keeps both counts: the table's is
/// the number of the line, exactly; the hob's is what its interpolator has counted by then.
class Counters {
 public:
  Counters(const Scenario& actual, const mechanics::SignalState& hob_signals);

  /// Brings the table's reading head to where the mark passes it with the table at `head_rad`.
  void SetHead(double head_rad);

  void Arm(int edges, int samples, double table_rad, int direction);
  bool Armed() const { return wanted_ > 0; }
  /// The table's angle at which the next sample falls due.
  double NextTableAngle_rad() const;
  /// The counts as the table comes to that edge, `at` its state there; then the next one is awaited.
  CounterSample Count(const mechanics::GearTrainState& at);
  /// The counts as they stand, both as their interpolators have them.
  CounterSample Latch(const mechanics::GearTrainState& at);

  void Push(const CounterSample& sample);
  CounterSamples Empty();

  /// Error of the table's ring in its own angle, where nothing but the ring is wrong.
  double TableRingError_rad(double ring_rad) const {
    return encoders_.TableRing(0.0).Scale_rad(ring_rad) - ring_rad;
  }

 private:
  double TableShown_rad() const;
  double HobShown_rad(double hob_rad);
  double Counted_rad(const mechanics::InterpolatedSignal& signals, double scale_rad) const;

  HobEncoders encoders_;
  bool quantised_;
  double head_rad_ = 0.0;
  mechanics::RingEncoder table_ring_;
  mechanics::InterpolatedSignal table_edges_, table_signals_;
  double table_noise_rad_, hob_noise_rad_;
  Stream table_noise_, hob_noise_;
  int edges_ = 1;
  int wanted_ = 0;  // samples to come
  int direction_ = 1;
  std::int64_t next_line_ = 0;
  std::size_t capacity_;
  std::deque<CounterSample> fifo_;
  bool overrun_ = false;
};

}  // namespace twinbench::sim
