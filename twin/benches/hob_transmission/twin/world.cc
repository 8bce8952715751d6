#include "twin/benches/hob_transmission/twin/world.h"

#include <algorithm>
#include <cmath>

#include "twin/benches/hob_transmission/settings.h"
#include "twin/core/device_fault.h"

namespace twinbench::sim {
namespace {

/// Short enough for the cubic between two states: a line of 10 Hz is met to 1e-6 of its size, and so is the highest at any speed.
Duration PieceOf(const HobPath& path, double table_speed_rad_s) {
  const bool has_bodies = HobOf(path.actual()).mechanics.fidelity == "bullet";
  const Duration longest = has_bodies ? std::chrono::milliseconds(1) : std::chrono::milliseconds(2);
  const double most_rad = units::turn * 10.0 * 2e-3;
  double highest = 1.0;
  for (const mechanics::AngleHarmonic& h : path.Transmission()) highest = std::max(highest, h.order);
  const double fastest_rad_s = highest * std::abs(table_speed_rad_s);
  return fastest_rad_s * ToSeconds(longest) > most_rad ? FromSeconds(most_rad / fastest_rad_s) : longest;
}

}  // namespace

HobWorld::HobWorld(const Scenario& nominal)
    : path_(nominal),
      train_(
          mechanics::MakeGearTrain(mechanics::FidelityFromName(HobOf(actual()).mechanics.fidelity), path_.train())),
      counters_(actual(), path_.HobSignals()),
      interferometer_noise_(actual().RunSeed(), "interferometer.noise") {}

void HobWorld::Run(double hob_speed_rad_s, Duration ramp) {
  if (hob_speed_rad_s != 0.0)
    direction_ = (hob_speed_rad_s > 0.0) == (HobOf(actual()).transmission.Ratio() > 0.0) ? 1 : -1;
  const double fastest_rad_s = std::max(std::abs(hob_speed_rad_s), std::abs(hob_speed_rad_s_));
  piece_ = PieceOf(path_, HobOf(actual()).transmission.Ratio() * fastest_rad_s);
  hob_speed_rad_s_ = hob_speed_rad_s;
  constexpr Duration kRinging = std::chrono::seconds(5);  // 20 Hz servo, torsion with 1 % of damping: long over
  slowed_down_ = Now() + ramp;
  at_rest_ = slowed_down_ + kRinging;
  drive_.Now([&] { train_->Run(hob_speed_rad_s, ToSeconds(ramp)); });
}

void HobWorld::Mount(double head_rad) {
  if (hob_speed_rad_s_ != 0.0)
    throw DeviceFault(FaultKind::kRefused, "fixture", "nothing can be mounted while the table turns");
  fixture_.Now([&] { counters_.SetHead(head_rad); });
}

void HobWorld::Arm(int edges, int samples) {
  card_.Now([&] { counters_.Arm(edges, samples, train_->State().table_rad, direction_); });
}

void HobWorld::RunUntil(Time until) {
  while (Now() < until) {
    if (StandsStill()) return drive_.RunUntil(until);
    const Duration piece = PieceTo(hob_speed_rad_s_ == 0.0 ? std::min(until, at_rest_) : until);
    drive_.RunUntil(Now() + piece, [&] { Pass(piece); });
  }
}

Duration HobWorld::PieceTo(Time end) const {
  const Duration rest = end - Now();
  // While nothing is counted, time may pass in one piece.
  if (!counters_.Armed()) return rest;
  const bool is_steady = HobOf(actual()).mechanics.fidelity == "kinematic" && hob_speed_rad_s_ != 0.0 && Now() >= slowed_down_;
  if (!is_steady) return std::min(piece_, rest);
  // Up to the next edge nothing is counted either: half-way to it, as no error makes the table twice as fast.
  const double fastest_rad_s = 2.0 * std::abs(HobOf(actual()).transmission.Ratio() * hob_speed_rad_s_);
  const double way_rad = direction_ * (counters_.NextTableAngle_rad() - train_->State().table_rad);
  const double pieces = std::floor(way_rad / fastest_rad_s / ToSeconds(piece_));
  return ToSeconds(rest) < pieces * ToSeconds(piece_) ? rest : std::min(rest, piece_ * std::max(1L, static_cast<long>(pieces)));
}

/// What went on in the piece of time that ends now.
void HobWorld::Pass(Duration piece) {
  const mechanics::GearTrainState before = train_->State();
  train_->Advance(ToSeconds(piece));
  const mechanics::GearTrainState after = train_->State();
  if (counters_.Armed()) TakeSamples(before, after, Now() - piece);
  path_.Travel(after.table_rad);
}

void HobWorld::TakeSamples(const mechanics::GearTrainState& before, const mechanics::GearTrainState& after,
                           Time begin) {
  while (counters_.Armed()) {
    const auto time_s = mechanics::PassingTime_s(before, after, counters_.NextTableAngle_rad());
    if (!time_s) return;
    const Time then = begin + FromSeconds(*time_s - before.time_s);  // the train's clock stands still with it
    counters_.Push(SampleAt(mechanics::Between(before, after, *time_s), then));
  }
}

double HobWorld::Interferometer_rad(const mechanics::GearTrainState& at, double velocity_rad_s, Time now) {
  const double shown_rad = path_.Interferometer_rad(at.table_rad, at.hob_rad, velocity_rad_s, now);
  const double noise_rad = HobOf(actual()).interferometer.noise_rad;
  return std::isfinite(shown_rad) && noise_rad > 0.0 ? shown_rad + noise_rad * interferometer_noise_.Normal()
                                                     : shown_rad;
}

CounterSample HobWorld::Latch() {
  CounterSample sample;
  const mechanics::GearTrainState at = train_->State();
  card_.Now([&] { sample = Completed(counters_.Latch(at), at, Now()); });
  return sample;
}

CounterSample HobWorld::SampleAt(const mechanics::GearTrainState& at, Time now) {
  return Completed(counters_.Count(at), at, now);
}

CounterSample HobWorld::Completed(CounterSample sample, const mechanics::GearTrainState& at, Time now) {
  sample.time = now;
  sample.velocity_rad_s = HobOf(actual()).transmission.Ratio() * hob_speed_rad_s_;
  sample.interferometer_rad = Interferometer_rad(at, sample.velocity_rad_s, now);
  path_.Travel(at.table_rad);
  path_.Disturb({sample.time, next_reading_++, at.table_rad, sample.velocity_rad_s}, sample);
  return sample;
}

}  // namespace twinbench::sim
