#include "twin/procedure/watched_way.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "twin/core/device_fault.h"
#include "twin/procedure/stood.h"
#include "twin/procedure/whereabouts.h"

namespace twinbench::procedure {
namespace {

constexpr double kShareOfSpeed = 0.1;
constexpr double kLittleMore_s = 0.25, kTimesKnown = 2.0;
constexpr double kSameFromLookToLook = 1e-5;

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
  const double near = stood || was_cut ? 0.1 * kNear : kNear;
  bool all_elsewhere = course_ != Course::kUnknown && !seen_.empty(), moves = seen_.empty();
  for (std::size_t k = 0; k < at.size() && !seen_.empty(); ++k) {
    const double target = course_ == Course::kGoes ? target_[k] : seen_[k];
    const bool is_elsewhere = at[k] < std::min(seen_[k], target) - near || at[k] > std::max(seen_[k], target) + near;
    const double in_s = ToSeconds(now - seen_at_), own = fastest_[k] > 0.0 ? kTimesKnown * fastest_[k] * in_s : INFINITY;
    const bool is_too_fast = std::abs(at[k] - seen_[k]) > (stood ? FurthestIn(axes_[k], in_s) : kNear + own);
    const bool is_suspect = is_elsewhere + is_too_fast + was_cut > 1;
    if (course_ != Course::kUnknown && is_suspect) was_cut ? LoseZeros() : void(has_lost_zero_[k] = true);
    all_elsewhere = all_elsewhere && is_elsewhere;
    moves = moves || std::abs(at[k] - seen_[k]) > kSameFromLookToLook;
  }
  if (has_stopped_ && !moves) course_ = Course::kStands;
  seen_ = at, seen_at_ = now;
  return all_elsewhere;
}

bool WatchedWay::MayBeGarbled(const std::vector<double>& at, Time now) const {
  WatchedWay then = *this;
  return then.Seen(at, now) || then.has_lost_zero_ != has_lost_zero_;
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

}  // namespace twinbench::procedure
