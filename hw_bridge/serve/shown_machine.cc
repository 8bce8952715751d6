#include "hw_bridge/serve/shown_machine.h"

#include <algorithm>

namespace twinbench::hw {
namespace {

constexpr Duration kUnderWay =
    std::chrono::seconds(1);  // so long behind its start a move freezes or meets a switch

bool Stops(Injected kind) {
  return kind == Injected::kStandStill || kind == Injected::kLimit;
}

}  // namespace

/// A fault that had no time to strike waits for the next move.
void ShownMachine::Begin() {
  const Injected waiting = Stops(mishap_.kind) && !IsStuck() ? mishap_.kind : faults_.TakeMove(kName);
  mishap_ = {waiting, clock_.Now() + kUnderWay, {}, mishap_.referenced};
}

void ShownMachine::StartMove(const std::vector<double>& to, double feed_m_s) {
  machine_.StartMove(to, feed_m_s);
  Begin();
}

void ShownMachine::StartArc(const Arc& arc) {
  machine_.StartArc(arc);
  Begin();
}

void ShownMachine::StartTurning(std::size_t axis, double speed_rad_s, Duration ramp) {
  machine_.StartTurning(axis, speed_rad_s, ramp);
  Begin();
}

/// The machine stops in the middle of its way, if it has not come to the end of it before.
void ShownMachine::Strike() {
  if (!Stops(mishap_.kind) || IsStuck() || clock_.Now() < mishap_.strikes) return;
  std::vector<AxisState> stuck = machine_.State();
  if (!stuck.front().moving) return;
  machine_.Stop();
  for (AxisState& axis : stuck) {
    axis.in_position = false;
    axis.moving = mishap_.kind == Injected::kStandStill;
  }
  if (mishap_.kind == Injected::kLimit) {
    stuck.front().limit = stuck.front().commanded < stuck.front().encoder ? -1 : 1;
    stuck.front().fault = "limit switch";
  }
  mishap_.stuck = std::move(stuck);
}

bool ShownMachine::Settles(Duration within) {
  const Time end = clock_.Now() + within;
  if (Stops(mishap_.kind) && !IsStuck()) {
    const Duration until_then = std::max(mishap_.strikes - clock_.Now(), Duration(0));
    if (machine_.Settles(std::min(within, until_then))) return true;
    Strike();
  }
  const Duration left = end - clock_.Now();
  if (!IsStuck() && mishap_.kind != Injected::kNotInPosition) return machine_.Settles(left);
  if (left > Duration(0)) clock_.Wait(left);
  return false;
}

std::vector<AxisState> ShownMachine::State() {
  Strike();
  std::vector<AxisState> states = IsStuck() ? mishap_.stuck : machine_.State();
  for (AxisState& axis : states) {
    axis.referenced = mishap_.referenced;
    if (mishap_.kind == Injected::kNotInPosition) axis.in_position = false;
  }
  return states;
}

void ShownMachine::Stop() {
  machine_.Stop();
  mishap_ = {Injected::kNone, {}, {}, mishap_.referenced};
}

void ShownMachine::Home() {
  machine_.Home();
  mishap_ = {};
}

void ShownMachine::StrikeRestart() {
  if (faults_.TakeRestart(kName) == Injected::kNone) return;
  machine_.Stop();
  mishap_ = {Injected::kNone, {}, {}, false};
}

}  // namespace twinbench::hw
