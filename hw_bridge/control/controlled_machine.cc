#include "hw_bridge/control/controlled_machine.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <thread>

namespace twinbench::hw {
namespace {

constexpr Duration kPollMachine = std::chrono::milliseconds(20);
constexpr Duration kHomingLook = std::chrono::seconds(1);

}  // namespace

ControlledMachine::ControlledMachine(DeviceLine line, std::vector<MachineAxis> axes, std::vector<AxisLimits> limits,
                                     const MachineManner& manner)
    : line_(std::move(line)), axes_(std::move(axes)), limits_(std::move(limits)), manner_(manner) {
  Require(limits_.size() == axes_.size(), "limits are one entry an axis");
}

std::string ControlledMachine::Place(std::size_t axis, double at) const {
  return fmt::format("{:.6f} {}", at / axes_[axis].to_SI(), axes_[axis].unit());
}

void ControlledMachine::AgreeOnLimits() {
  const std::vector<AllowedMotion> travel = agreed_ = Allowed();
  for (std::size_t k = 0; k < axes_.size(); ++k) {
    AxisLimits& ours = limits_[k];
    if (std::isinf(ours.lower)) ours.lower = travel[k].lower;
    if (std::isinf(ours.upper)) ours.upper = travel[k].upper;
    const double slack = Understood(axes_[k]);
    if (ours.lower >= travel[k].lower - slack && ours.upper <= travel[k].upper + slack) continue;
    line_.Fail(FaultKind::kRefused, fmt::format("the controller allows axis {} {} to {}; the bench file {} to {}",
                                                axes_[k].name, Place(k, travel[k].lower), Place(k, travel[k].upper),
                                                Place(k, ours.lower), Place(k, ours.upper)));
  }
}

std::vector<AllowedMotion> ControlledMachine::Allowed() {
  std::vector<AllowedMotion> allowed;
  for (const AxisLimits& travel : Travel()) allowed.push_back({travel.lower, travel.upper, Fastest(allowed.size())});
  return allowed;
}

void ControlledMachine::RequireAllowedAsAgreed() {
  if (agreed_.empty()) return;
  const std::vector<AllowedMotion> now = Allowed();
  for (std::size_t k = 0; k < axes_.size(); ++k) RequireAsAgreed(line_, axes_[k], agreed_[k], now[k]);
}

void ControlledMachine::RequireWithinLimits(std::size_t axis, double to) {
  const double slack = Understood(axes_[axis]);
  if (to >= limits_[axis].lower - slack && to <= limits_[axis].upper + slack) return;
  line_.Fail(FaultKind::kLimit,
             fmt::format("a move of axis {} to {} was not sent: its limits are {} and {}", axes_[axis].name,
                         Place(axis, to), Place(axis, limits_[axis].lower), Place(axis, limits_[axis].upper)));
}

void ControlledMachine::RequireReady(const std::vector<AxisState>& states) {
  for (std::size_t k = 0; k < states.size(); ++k) {
    if (!states[k].referenced)
      line_.Fail(FaultKind::kRestarted,
                 fmt::format("axis {} has lost its origin; its coordinates mean nothing", axes_[k].name));
  }
}

bool ControlledMachine::Settles(Duration within) {
  const auto end = std::chrono::steady_clock::now() + within;
  while (!AskDone()) {
    line_.RequireGoingOn();
    const Duration left = end - std::chrono::steady_clock::now();
    if (left <= Duration(0)) return false;
    std::this_thread::sleep_for(std::min(left, kPollMachine));
  }
  return true;
}

void ControlledMachine::Stop() {
  line_.SayFirst(StopWord());
  SendStop();
}

void ControlledMachine::Home() {
  SendHome();
  double longest_s = 0.0, passed_s = 0.0;
  for (const AxisLimits& limits : limits_) longest_s = std::max(longest_s, limits.move_timeout_s);
  while (!FindsOrigin(kHomingLook)) {
    passed_s += ToSeconds(kHomingLook);
    if (passed_s >= longest_s)
      StopAndFail(FaultKind::kNotInPosition, fmt::format("no origin found in {:.0f} s", passed_s));
  }
  RequireReady(State());
}

}  // namespace twinbench::hw
