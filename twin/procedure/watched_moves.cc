#include "twin/procedure/watched_moves.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "twin/core/device_fault.h"
#include "twin/procedure/stood.h"
#include "twin/procedure/whereabouts.h"

namespace twinbench::procedure {
namespace {

constexpr Duration kWatchedEvery = std::chrono::milliseconds(100);
constexpr double kShareOfSpeed = 0.1;
constexpr double kLittleMore_s = 0.25, kTimesKnown = 2.0;
constexpr double kNear = 1e-3;  // m or rad: where axes settle, as slowly as they like
constexpr double kSameFromLookToLook = 1e-5;

std::vector<double> EachOf(const std::vector<AxisState>& states, double AxisState::*what) {
  std::vector<double> all;
  for (const AxisState& state : states) all.push_back(state.*what);
  return all;
}

/// What is for whoever watches the move, whose looks are in the record; a switch that the axis leaves is not.
template <class State>
bool IsForOthers(const State& state, double left) {
  if (state.limit != 0) return !(state.limit * left < 0.0);
  return !state.referenced || !state.fault.empty();
}

/// @throws what `ask` throws, which may be the silence of one that is switched off and on.
auto Ask(WatchedWay& way, auto&& ask) {
  try {
    return ask();
  } catch (...) {
    way.IsCut();
    throw;
  }
}

/// Lets `within` pass and looks in between.
/// @param look  false: no more.
bool SettlesWatched(auto& moves, Duration within, const std::function<bool()>& look) {
  for (Duration left = within;; left -= kWatchedEvery) {
    if (moves.Settles(std::min(left, kWatchedEvery))) return true;
    if (!look() || left <= kWatchedEvery) return false;
  }
}

}  // namespace

void WatchedWay::Begins(const std::vector<double>& from, const std::vector<double>& to,
                        const std::vector<double>& at, Time now, Duration took) {
  for (std::size_t k = 0; k < to.size(); ++k) RequireOnWay(axes_[k], from[k], to[k], at[k], ToSeconds(took));
  to_ = target_ = to, at_ = at, shown_ = now;
  course_ = Course::kGoes, has_stopped_ = false;
  slow_s_ = slowest_s_ = 0.0;
  has_our_targets_ = false;
}

void WatchedWay::RequireOurs(const std::vector<double>& commanded) {
  bool has_all = !to_.empty();
  for (std::size_t k = 0; k < to_.size(); ++k) {
    const bool is_ours = std::abs(commanded[k] - to_[k]) <= kSameTarget;
    if (has_our_targets_ && !is_ours && !std::isnan(commanded[k])) TellSentElsewhere(axes_[k], to_[k], commanded[k]);
    has_all = has_all && is_ours;
  }
  has_our_targets_ = has_all;
}

bool WatchedWay::IsSlow(const std::vector<double>& at, double in_s) {
  bool is_slow = true;
  for (std::size_t k = 0; k < at.size(); ++k) {
    const double speed = std::abs(at[k] - at_[k]) / in_s;
    fastest_[k] = std::fmax(fastest_[k], speed);
    is_slow = is_slow && !(speed > kShareOfSpeed * fastest_[k]);
  }
  return is_slow;
}

bool WatchedWay::HasFarToGo(const std::vector<double>& at) const {
  for (std::size_t k = 0; k < at.size(); ++k)
    if (std::abs(to_[k] - at[k]) > kNear) return true;
  return false;
}

void WatchedWay::Shows(const std::vector<double>& at, Time now, double stall_s) {
  const double in_s = ToSeconds(now - shown_);
  if (to_.empty() || !(in_s > 0.0)) return;
  slow_s_ = IsSlow(at, in_s) && HasFarToGo(at) ? slow_s_ + in_s : 0.0;
  slowest_s_ = std::max(slowest_s_, slow_s_);
  at_ = at, shown_ = now;
  if (!(slow_s_ > std::fmin(stall_s, kLittleMore_s + kTimesKnown * known_slow_s_))) return;
  std::string where;
  for (std::size_t k = 0; k < at.size(); ++k)
    where += fmt::format("{}{} at {:.6f} {}", k > 0 ? ", " : "", axes_[k].name, at[k] / axes_[k].to_SI(),
                         axes_[k].unit());
  throw DeviceFault(FaultKind::kStalled, axes_.size() == 1 ? axes_[0].name : "machine",
                    fmt::format("stands or creeps on its way, {}, for {:.1f} s", where, slow_s_));
}

void WatchedWay::HasEnded() {
  if (!to_.empty()) known_slow_s_ = std::fmax(known_slow_s_, slowest_s_);
  to_.clear();
  HasStopped();
}

void WatchedWay::IsAnother(std::vector<double> to) {
  to_.clear();
  course_ = to.empty() ? Course::kUnknown : Course::kGoes, has_stopped_ = false;
  target_ = std::move(to);
}

bool WatchedWay::Seen(const std::vector<double>& at, Time now) {
  const bool was_cut = std::exchange(is_cut_, false), stood = course_ == Course::kStands;
  bool all_elsewhere = stood, moves = seen_.empty();
  for (std::size_t k = 0; k < at.size() && !seen_.empty(); ++k) {
    const double target = course_ == Course::kGoes ? target_[k] : seen_[k];
    const bool is_elsewhere = at[k] < std::min(seen_[k], target) - kNear || at[k] > std::max(seen_[k], target) + kNear;
    const bool is_too_fast = stood && std::abs(at[k] - seen_[k]) > FurthestIn(axes_[k], ToSeconds(now - seen_at_));
    if (course_ != Course::kUnknown && is_elsewhere && (was_cut || is_too_fast)) has_lost_zero_[k] = true;
    all_elsewhere = all_elsewhere && is_elsewhere;
    moves = moves || std::abs(at[k] - seen_[k]) > kSameFromLookToLook;
  }
  if (has_stopped_ && !moves) course_ = Course::kStands;
  seen_ = at, seen_at_ = now;
  return all_elsewhere;
}

void WatchedWay::HasFoundZeros() {
  has_lost_zero_.assign(axes_.size(), false);
  seen_.clear();
  IsAnother();
}

void WatchedWay::RequireZeros() const {
  for (std::size_t k = 0; k < axes_.size(); ++k)
    if (has_lost_zero_[k]) throw DeviceFault(FaultKind::kRestarted, axes_[k].name, "has lost its origin: it counts from another zero than before");
}

std::vector<AxisState> WatchedMachine::State() {
  std::vector<AxisState> states = Ask(way_, [&] { return inner_.State(); });
  if (way_.WasCut() && std::abs(OffCircle_m(states)) > kNear) way_.LoseZeros();
  way_.Seen(EachOf(states, &AxisState::encoder), clock_.Now());
  for (std::size_t k = 0; k < states.size(); ++k)
    if (way_.HasLostZero(k)) states[k].referenced = false;
  return states;
}

void WatchedMachine::Stop() {
  way_.HasStopped();
  Ask(way_, [&] { inner_.Stop(); });
}

void WatchedMachine::Home() {
  Ask(way_, [&] { inner_.Home(); });
  way_.HasFoundZeros();
}

void WatchedMachine::StartMove(const std::vector<double>& to, double feed_m_s) {
  const std::vector<double> from = EachOf(State(), &AxisState::encoder);
  way_.RequireZeros();
  const Time sent = clock_.Now();
  round_.reset();
  way_.IsAnother(to);
  Ask(way_, [&] { inner_.StartMove(to, feed_m_s); });
  const std::vector<AxisState> states = State();
  const Time now = clock_.Now();
  way_.Begins(from, to, EachOf(states, &AxisState::encoder), now, now - sent);
  way_.RequireOurs(EachOf(states, &AxisState::commanded));
  if (feed_m_s > 0.0) way_.IsAnother(to);
}

void WatchedMachine::StartArc(const Arc& arc) {
  radius_m_ = RadiusNow_m(arc, State());
  way_.RequireZeros();
  round_ = arc;
  way_.IsAnother();
  Ask(way_, [&] { inner_.StartArc(arc); });
}

double WatchedMachine::OffCircle_m(const std::vector<AxisState>& states) const {
  return round_ ? RadiusNow_m(*round_, states) - radius_m_ : 0.0;
}

void WatchedMachine::RequireOnCircle(const std::vector<AxisState>& states) const {
  const double off_m = OffCircle_m(states);
  if (std::abs(off_m) > kNear)
    throw DeviceFault(FaultKind::kFollowing, "machine",
                      fmt::format("is {:.4g} mm off the circle that it was sent round: who else moves it?", off_m / units::mm));
}

void WatchedMachine::StartTurning(std::size_t axis, double speed_rad_s, Duration ramp) {
  way_.IsAnother();
  round_.reset();
  Ask(way_, [&] { inner_.StartTurning(axis, speed_rad_s, ramp); });
}

bool WatchedMachine::Settles(Duration within) {
  const auto look = [this] {
    const std::vector<AxisState> states = State();
    for (std::size_t k = 0; k < states.size(); ++k)
      if (IsForOthers(states[k], way_.To(k) - states[k].encoder)) return false;
    way_.RequireOurs(EachOf(states, &AxisState::commanded));
    RequireOnCircle(states);
    way_.Shows(EachOf(states, &AxisState::encoder), clock_.Now(), LimitsOf(limits_, 0).stall_s);
    return true;
  };
  const bool settles = Ask(way_, [&] { return SettlesWatched(inner_, within, look); });
  if (settles) way_.HasEnded();
  return settles;
}

WatchedTables::WatchedTables(RotaryBench& bench, const TableLimits& target, const TableLimits& reference)
    : target_(bench.target, bench.clock, target, "target", reference_),
      reference_(bench.reference, bench.clock, reference, "reference", target_) {}

void WatchedTables::LoseZeros() {
  for (Table* table : {&target_, &reference_}) table->LoseZero();
}

auto WatchedTables::Table::AskBoth(auto&& ask) {
  return Ask(way_, [&] { return Ask(other_.way_, ask); });
}

bool WatchedTables::Table::IsElsewhere(const TableState& state) {
  return way_.Seen({state.encoder_rad}, clock_.Now());
}

TableState WatchedTables::Table::State() {
  TableState state = AskBoth([&] { return inner_.State(); });
  if (IsElsewhere(state) && other_.IsElsewhere(AskBoth([&] { return other_.inner_.State(); })))
    for (Table* table : {this, &other_}) table->LoseZero();
  state.referenced = state.referenced && !way_.HasLostZero(0);
  return state;
}

void WatchedTables::Table::Home() {
  AskBoth([&] { inner_.Home(); });
  way_.HasFoundZeros();
}

void WatchedTables::Table::StartMove(double angle_rad) {
  if (std::isnan(from_rad_)) {
    LookBefore();
    other_.LookBefore();
  }
  way_.RequireZeros();
  to_rad_ = angle_rad;
  sent_ = clock_.Now();
  way_.IsAnother({angle_rad});
  AskBoth([&] { inner_.StartMove(angle_rad); });
  is_sent_ = true;
}

void WatchedTables::Table::Stop() {
  from_rad_ = other_.from_rad_ = kNaN;
  way_.HasStopped();
  AskBoth([&] { inner_.Stop(); });
}

void WatchedTables::Table::LookAtStart() {
  const double from_rad = std::exchange(from_rad_, kNaN);
  if (!std::exchange(is_sent_, false)) return;
  const TableState state = State();
  const Time now = clock_.Now();
  way_.Begins({from_rad}, {to_rad_}, {state.encoder_rad}, now, now - sent_);
  way_.RequireOurs({state.commanded_rad});
}

bool WatchedTables::Table::LookOnWay() {
  const TableState state = State();
  if (IsForOthers(state, to_rad_ - state.encoder_rad)) return false;
  way_.RequireOurs({state.commanded_rad});
  way_.Shows({state.encoder_rad}, clock_.Now(), limits_.stall_s);
  return true;
}

bool WatchedTables::Table::Settles(Duration within) {
  for (Table* table : {this, &other_}) table->LookAtStart();
  const bool settles = AskBoth([&] {
    return SettlesWatched(inner_, within, [this] {
      other_.LookOnWay();  // whatever else it shows is told when it is waited for
      return LookOnWay();
    });
  });
  if (settles) way_.HasEnded();
  return settles;
}

}  // namespace twinbench::procedure
