#include "twin/benches/hob_transmission/twin/counters.h"

#include "twin/benches/hob_transmission/settings.h"

namespace twinbench::sim {
namespace {

double Draw(double sd_rad, Stream& stream) {
  return sd_rad > 0.0 ? sd_rad * stream.Normal() : 0.0;
}

}  // namespace

Counters::Counters(const Scenario& actual, const mechanics::SignalState& hob_signals)
    : encoders_(actual, hob_signals),
      quantised_(!actual.noise_free),
      table_ring_(encoders_.TableRing(0.0)),
      table_edges_({}, HobOf(actual).table_encoder.lines, 1),
      table_signals_({}, HobOf(actual).table_encoder.lines, HobOf(actual).table_encoder.interpolation),
      table_noise_rad_(HobOf(actual).table_encoder.noise_rad),
      hob_noise_rad_(HobOf(actual).hob_encoder.noise_rad),
      table_noise_(actual.RunSeed(), "table_encoder.noise"),
      hob_noise_(actual.RunSeed(), "hob_encoder.noise"),
      capacity_(static_cast<std::size_t>(HobOf(actual).hob_procedure.fifo_samples)) {}

void Counters::SetHead(double head_rad) {
  head_rad_ = head_rad;
  table_ring_ = encoders_.TableRing(head_rad);
}

void Counters::Arm(int edges, int samples, double table_rad, int direction) {
  fifo_.clear();
  overrun_ = false;
  edges_ = edges;
  wanted_ = samples;
  direction_ = direction;
  next_line_ = table_edges_.NextFallingStep(table_ring_.Scale_rad(table_rad), direction);
  while (next_line_ % edges != 0) next_line_ += direction;
}

double Counters::NextTableAngle_rad() const {
  return table_ring_.Shaft_rad(table_edges_.FallingEdge_rad(next_line_, direction_));
}

/// The edge's own place on an ideal scale: the count is exact there.
double Counters::TableShown_rad() const {
  return encoders_.TableShown_rad(table_edges_.FallingEdge_rad(next_line_, direction_), head_rad_);
}

double Counters::HobShown_rad(double hob_rad) {
  const double scale_rad = encoders_.hob_ring().Scale_rad(hob_rad) + Draw(hob_noise_rad_, hob_noise_);
  return Counted_rad(encoders_.hob_signals(), scale_rad);
}

double Counters::Counted_rad(const mechanics::InterpolatedSignal& signals, double scale_rad) const {
  if (!quantised_) return signals.Shown_rad(scale_rad);
  return (static_cast<double>(signals.Steps(scale_rad)) + 0.5) * signals.Step_rad();
}

CounterSample Counters::Count(const mechanics::GearTrainState& at) {
  CounterSample sample;
  sample.table_encoder_rad = TableShown_rad() + Draw(table_noise_rad_, table_noise_);
  sample.hob_encoder_rad = HobShown_rad(at.hob_rad);
  next_line_ += direction_ * edges_;
  --wanted_;
  return sample;
}

CounterSample Counters::Latch(const mechanics::GearTrainState& at) {
  const double scale_rad = table_ring_.Scale_rad(at.table_rad) + Draw(table_noise_rad_, table_noise_);
  CounterSample sample;
  sample.table_encoder_rad = encoders_.TableShown_rad(Counted_rad(table_signals_, scale_rad), head_rad_);
  sample.hob_encoder_rad = HobShown_rad(at.hob_rad);
  return sample;
}

void Counters::Push(const CounterSample& sample) {
  overrun_ = overrun_ || fifo_.size() >= capacity_;
  if (!overrun_) fifo_.push_back(sample);
}

CounterSamples Counters::Empty() {
  const CounterSamples look{{fifo_.begin(), fifo_.end()}, overrun_};
  fifo_.clear();
  return look;
}

}  // namespace twinbench::sim
