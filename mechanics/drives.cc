#include "mechanics/drives.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace twinbench::mechanics {
namespace {

constexpr double kQuiet_rad = 0.01 / 3600.0 * std::numbers::pi / 180.0;  // 0.01 arcsec

}  // namespace

Nanoseconds ToNanoseconds(double time_s) {
  if (!(time_s >= 0.0)) throw std::invalid_argument("plant: time only passes forwards");
  return std::llround(time_s * 1e9);
}

void Commands::Start(Axis axis, double to_rad, double duration_s, Nanoseconds now) {
  const std::size_t i = Index(axis);
  if (!Ended(i, now)) throw std::logic_error("plant: a move cannot start while the axis' last profile runs");
  profile_[i] = QuinticProfile(profile_[i].to_rad(), to_rad, duration_s);
  start_[i] = now;
}

bool Commands::Stop(Axis axis, double duration_s, Nanoseconds now) {
  const std::size_t i = Index(axis);
  if (Ended(i, now)) return false;
  const ProfilePoint here = At(i, now);
  profile_[i] = QuinticProfile(here, here.position_rad + 0.5 * here.velocity_rad_s * duration_s, duration_s);
  start_[i] = now;
  return true;
}

double Commands::Left_s(Nanoseconds now) const {
  double left_s = 0.0;
  for (std::size_t i = 0; i < 2; ++i) {
    // Rounded up, so that the profile has ended then.
    const auto end = start_[i] + static_cast<Nanoseconds>(std::ceil(profile_[i].duration_s() * 1e9));
    left_s = std::max(left_s, ToSeconds(end - now));
  }
  return left_s;
}

PeriodCommand Commands::Period(Nanoseconds time, Nanoseconds period) const {
  PeriodCommand command;
  Eigen::Vector2d speed;
  for (std::size_t i = 0; i < 2; ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    command.Set(k, At(i, time), At(i, time + period), ToSeconds(period));
    speed[k] = At(i, time + period / 2).velocity_rad_s;
  }
  command.speed_products << speed[0] * speed[0], speed[0] * speed[1], speed[1] * speed[1];
  return command;
}

DrivenPlant::DrivenPlant(const StackParameters& parameters)
    : parameters_((Check(parameters), parameters)),
      backlash_{Backlash(parameters.table[0].backlash_rad), Backlash(parameters.table[1].backlash_rad)},
      period_(ToNanoseconds(parameters.servo_period_s)) {}

void DrivenPlant::StartMove(Axis axis, double to_rad, double duration_s) {
  commands_.Start(axis, to_rad, duration_s, now_);
  if (Settled()) Wake();
  quiet_[Index(axis)] = 0;
  OnStart();
}

void DrivenPlant::Stop(Axis axis) {
  if (!commands_.Stop(axis, kBraking_s, now_)) return;
  quiet_[Index(axis)] = 0;
  OnStart();
}

void DrivenPlant::Advance(double dt_s) {
  now_ += ToNanoseconds(dt_s);
  while (stepped_ + period_ <= now_) {
    if (Settled() && CanRest()) {
      const std::int64_t periods = (now_ - stepped_) / period_;
      Rest(periods);
      stepped_ += periods * period_;
    } else {
      Tick();
    }
  }
  if (stepped_ < now_) Prepare(stepped_);
}

void DrivenPlant::Wake() {
  OnWake(now_ - stepped_);
  stepped_ = now_;
}

void DrivenPlant::Tick() {
  Step(stepped_);
  stepped_ += period_;
  if (backlash_[0].active() || backlash_[1].active()) FollowBacklash();
  WatchQuiet();
}

void DrivenPlant::WatchQuiet() {
  const std::array<bool, 2> ended = {commands_.Ended(0, stepped_), commands_.Ended(1, stepped_)};
  if (!ended[0] && !ended[1]) return;  // neither has been quiet since its move started
  const Eigen::Vector2d deviation = Deviation_rad();
  for (std::size_t i = 0; i < 2; ++i) {
    const bool near = ended[i] && std::abs(ShownDeviation_rad(i, deviation[static_cast<Eigen::Index>(i)])) <
                                      std::max(kQuiet_rad, 0.6 * parameters_.table[i].scale.resolution_rad);
    quiet_[i] = near ? quiet_[i] + period_ : 0;
  }
}

/// What the scale shows of it, before it is cut into steps.
double DrivenPlant::ShownDeviation_rad(std::size_t table, double deviation_rad) const {
  const ScaleParameters& scale = parameters_.table[table].scale;
  if (scale.subdivision_rad == 0.0) return deviation_rad;
  const double command_rad = commands_.At(table, stepped_).position_rad;
  return Interpolated_rad(scale, command_rad + deviation_rad) - command_rad;
}

void DrivenPlant::FollowBacklash() {
  const Eigen::Vector2d deviation = Deviation_rad();
  for (std::size_t i = 0; i < 2; ++i) {
    backlash_[i].Follow(commands_.At(i, stepped_).position_rad + deviation[static_cast<Eigen::Index>(i)]);
  }
}

StackState DrivenPlant::State() const {
  const Vector12 coordinates = Coordinates(stepped_, now_ - stepped_);
  StackState state;
  const double target_rad = commands_.At(0, now_).position_rad + coordinates[SpinIndex(0)];
  const double reference_rad = commands_.At(1, now_).position_rad + coordinates[SpinIndex(1)];
  state.target_encoder_rad = Shown_rad(parameters_.table[0].scale, target_rad);
  state.reference_encoder_rad = Shown_rad(parameters_.table[1].scale, reference_rad);
  state.target_rad = Backlash(backlash_[0]).Follow(target_rad);
  state.reference_rad = Backlash(backlash_[1]).Follow(reference_rad);
  const std::array<BearingPose, 2> bearings = Bearings(coordinates, state.target_rad, state.reference_rad);
  state.target_bearing = bearings[0];
  state.reference_bearing = bearings[1];
  return state;
}

void DrivenPlant::Mount(const ChainGeometry& geometry) {
  if (!Settled()) throw std::logic_error("plant: mounting needs tables at rest");
  Wake();
  parameters_.geometry = geometry;
  OnMount();
}

}  // namespace twinbench::mechanics
