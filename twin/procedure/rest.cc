#include "twin/procedure/rest.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <thread>
#include <utility>

#include "twin/core/nothing_moves.h"
#include "twin/procedure/whereabouts.h"

namespace twinbench::procedure {
namespace {

constexpr Duration kBetweenLooks = std::chrono::milliseconds(500);
constexpr int kLooksOfRest = 3;
constexpr int kLooksInTime = 10;  // behind which nobody waits any more ...
constexpr int kMostLooks = 20;    // ... but for what gets slower
constexpr double kSlower = 0.95;  // from look to look
constexpr int kLooksUntilSaidAgain = 3;  // to what moves on; some are busy for a moment with every word. To what stood and moves again, at once
constexpr int kFailuresOfADeadLink = 8;
constexpr Duration kDeadAfter = std::chrono::milliseconds(3500);  // of nothing but failures
constexpr double kRestsWithin = 1e-5;                 // m or rad: where no in-position limit is known

/// What an axis has shown since it was last seen to move.
class RestWatch {
 public:
  void Look(const SeenAxis& seen) {
    const double width = std::isfinite(seen.in_position) ? seen.in_position : kRestsWithin;
    const double step = std::abs(seen.encoder - axis_.encoder);  // NaN at the first look
    slows_ = step < kSlower * std::exchange(step_, step);
    axis_ = seen;
    const double lowest = std::fmin(lowest_, seen.encoder), highest = std::fmax(highest_, seen.encoder);
    moves_ = seen.moving || highest - lowest > width;  // the latter never, where the encoder shows nothing
    lowest_ = moves_ ? seen.encoder : lowest;
    highest_ = moves_ ? seen.encoder : highest;
    looks_ = seen.moving ? 0 : moves_ ? 1 : looks_ + 1;
  }

  bool AtRest() const { return looks_ >= kLooksOfRest; }
  bool Restless() const { return !AtRest(); }
  /// At the last look.
  bool Moves() const { return moves_; }
  bool Slows() const { return Restless() && slows_; }
  std::string Place() const {
    return fmt::format("{} at {:.6f} {}", axis_.name, axis_.encoder / (axis_.is_rotary ? units::deg : units::mm),
                       axis_.is_rotary ? "deg" : "mm");
  }

 private:
  SeenAxis axis_;
  bool moves_ = false, slows_ = false;
  int looks_ = 0;
  double lowest_ = kNaN, highest_ = kNaN, step_ = kNaN;
};

class AxesWatch {
 public:
  void Look(const std::vector<SeenAxis>& seen) {
    axes_.resize(seen.size());
    for (std::size_t k = 0; k < seen.size(); ++k) axes_[k].Look(seen[k]);
  }
  bool AtRest() const { return !axes_.empty() && std::ranges::all_of(axes_, &RestWatch::AtRest); }
  bool Moves() const { return std::ranges::any_of(axes_, &RestWatch::Moves); }
  bool Slows() const { return std::ranges::any_of(axes_, &RestWatch::Slows); }
  std::string Places(bool (RestWatch::*is_told)() const) const {
    std::string places;
    for (const RestWatch& axis : axes_)
      if ((axis.*is_told)()) places += (places.empty() ? "" : ", ") + axis.Place();
    return places;
  }

 private:
  std::vector<RestWatch> axes_;
};

/// Failures without any answer between them.
struct Silence {
  int failures = 0;
  HostTime since;
  Duration latest{0};  // took so long

  void Note(HostTime asked, HostTime now) {
    if (failures++ == 0) since = asked;
    latest = now - asked;
  }
  /// The next would be as long as the last.
  bool IsOfADeadLink(HostTime now) const { return failures > 1 && now - since + latest > kDeadAfter; }
};

/// One part on its way to rest.
class Stopping {
 public:
  /// @param silence  Of all parts, which may hang on one link.
  Stopping(const Stoppable& part, Silence& silence, const std::function<HostTime()>& now) : part_(&part), of_all_(&silence), now_(&now) {}

  void Say() {
    said_at_look_ = looks_;
    Try([this] {
      was_heard_ = false;
      part_->stop();
      was_heard_ = true;
    });
  }

  void Look() {
    if (!was_heard_) Say();
    if (IsDead()) return;
    const bool stood = looks_ > 0 && !watch_.Moves();
    Try([this] {
      watch_.Look(part_->look());
      ++looks_;
      silence_ = {};
    });
    const bool moves_on = stood || looks_ - said_at_look_ >= kLooksUntilSaidAgain;
    if (watch_.Moves() && moves_on) Say();
  }

  bool AtRest() const { return is_recording_ || watch_.AtRest(); }
  bool Slows() const { return watch_.Slows(); }
  /// Whether another look may tell more.
  bool IsOpen() const { return !AtRest() && !IsDead(); }
  std::string WhyNot() const {
    return silence_.failures > 0 ? why_not_ : fmt::format("still moving after the stop: {}", watch_.Places(&RestWatch::Restless));
  }

 private:
  bool IsDead() const {
    const HostTime now = (*now_)();
    return silence_.failures >= kFailuresOfADeadLink || silence_.IsOfADeadLink(now) || (silence_.failures > 0 && of_all_->IsOfADeadLink(now));
  }

  /// What fails may be the fault that is being dealt with.
  void Try(const std::function<void()>& ask) {
    const HostTime asked = (*now_)();
    try {
      ask();
      *of_all_ = {};
    } catch (const NothingMoves&) {
      is_recording_ = true;
    } catch (const BenchError& error) {
      for (Silence* silence : {&silence_, of_all_}) silence->Note(asked, (*now_)());
      why_not_ = error.what();
    }
  }

  const Stoppable* part_;
  AxesWatch watch_;
  bool was_heard_ = false, is_recording_ = false;
  int looks_ = 0, said_at_look_ = 0;
  Silence silence_;  // since the last look that was answered
  Silence* of_all_;
  const std::function<HostTime()>* now_;
  std::string why_not_;
};

/// A bench whose clock fails too is a real one.
void PauseBetweenLooks(Clock& clock) {
  try {
    clock.Wait(kBetweenLooks);
  } catch (const BenchError&) {
    std::this_thread::sleep_for(kBetweenLooks);
  }
}

}  // namespace

std::vector<SeenAxis> LookAt(RotaryTable& table, const std::string& name, const TableLimits& limits) {
  const TableState state = table.State();
  return {{name, true, state.moving, state.encoder_rad, limits.in_position_rad}};
}

std::vector<SeenAxis> LookAt(MachineController& machine, const std::vector<AxisLimits>& limits) {
  const std::vector<AxisState> states = machine.State();
  std::vector<SeenAxis> seen;
  for (std::size_t k = 0; k < states.size(); ++k) {
    const MachineAxis& axis = machine.Axes()[k];
    seen.push_back({axis.name, axis.is_rotary, states[k].moving, states[k].encoder, LimitsOf(limits, k).in_position});
  }
  return seen;
}

Standstill BringToRest(Clock& clock, const std::vector<Stoppable>& parts, const std::function<HostTime()>& now) {
  Silence silence;
  std::vector<Stopping> all;
  for (const Stoppable& part : parts) all.emplace_back(part, silence, now);
  for (Stopping& part : all) part.Say();
  for (int look = 0; look < kMostLooks && std::ranges::any_of(all, &Stopping::IsOpen); ++look) {
    if (look >= kLooksInTime && std::ranges::none_of(all, &Stopping::Slows)) break;
    if (look > 0) PauseBetweenLooks(clock);
    for (Stopping& part : all)
      if (part.IsOpen()) part.Look();
  }
  std::string why_not;
  for (const Stopping& part : all)
    if (!part.AtRest()) why_not += (why_not.empty() ? "" : "; ") + part.WhyNot();
  return {why_not.empty(), why_not};
}

Standstill WhetherAtRest(const std::vector<AxesLook>& looks) {
  std::vector<AxesWatch> all(looks.size());
  for (int look = 0; look < kLooksOfRest; ++look) {
    if (look > 0) std::this_thread::sleep_for(kBetweenLooks);
    for (std::size_t k = 0; k < looks.size(); ++k) all[k].Look(looks[k]());
    if (std::ranges::any_of(all, &AxesWatch::Moves)) break;
  }
  std::string moving;
  for (const AxesWatch& part : all) {
    const std::string places = part.Places(&RestWatch::Moves);
    if (!places.empty()) moving += (moving.empty() ? "" : ", ") + places;
  }
  return {moving.empty(), moving.empty() ? "" : "moving: " + moving};
}

}  // namespace twinbench::procedure
