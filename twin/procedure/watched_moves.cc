#include "twin/procedure/watched_moves.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "twin/core/device_fault.h"
#include "twin/procedure/whereabouts.h"

namespace twinbench::procedure {
namespace {

constexpr Duration kWatchedEvery = std::chrono::milliseconds(100);

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
bool SettlesWatched(Duration within, const std::function<bool(Duration)>& settles, const std::function<bool()>& look) {
  for (Duration left = within;; left -= kWatchedEvery) {
    if (settles(std::min(left, kWatchedEvery))) return true;
    if (!look() || left <= kWatchedEvery) return false;
  }
}

}  // namespace

std::vector<AxisState> WatchedMachine::State() {
  const auto ask = [&] { return Ask(way_, [&] { return inner_.State(); }); };
  std::vector<AxisState> states = ask();
  if (way_.MayBeGarbled(EachOf(states, &AxisState::encoder), clock_.Now())) states = ask();
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
  const auto settle = [this](Duration slice) { return Ask(way_, [&] { return inner_.Settles(slice); }); };
  const bool settles = SettlesWatched(within, settle, [this] {
    const std::vector<AxisState> states = State();
    for (std::size_t k = 0; k < states.size(); ++k)
      if (IsForOthers(states[k], way_.To(k) - states[k].encoder)) return false;
    way_.RequireOurs(EachOf(states, &AxisState::commanded));
    RequireOnCircle(states);
    way_.Shows(EachOf(states, &AxisState::encoder), clock_.Now(), LimitsOf(limits_, 0).stall_s);
    return true;
  });
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

TableState WatchedTables::Table::Asked() {
  const auto ask = [&] { return AskBoth([&] { return inner_.State(); }); };
  const TableState state = ask();
  return way_.MayBeGarbled({state.encoder_rad}, clock_.Now()) ? ask() : state;
}

bool WatchedTables::Table::IsElsewhere(const TableState& state) {
  return way_.Seen({state.encoder_rad}, clock_.Now());
}

TableState WatchedTables::Table::State() {
  TableState state = Asked();
  const bool was_cut = way_.WasCut(), had_zero = !way_.HasLostZero(0);
  const bool are_elsewhere = IsElsewhere(state) && other_.IsElsewhere(other_.Asked());
  if (are_elsewhere || (was_cut && had_zero && way_.HasLostZero(0)))
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
  const auto settle = [this](Duration slice) { return AskBoth([&] { return inner_.Settles(slice); }); };
  const bool settles = SettlesWatched(within, settle, [this] {
    other_.LookOnWay();  // whatever else it shows is told when it is waited for
    return LookOnWay();
  });
  if (settles) way_.HasEnded();
  return settles;
}

}  // namespace twinbench::procedure
