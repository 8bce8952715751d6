#include "twin/procedure/machine_watch.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <thread>

#include "twin/core/device_fault.h"

namespace twinbench::procedure {
namespace {

constexpr Duration kMachineLook = std::chrono::seconds(1);
constexpr Duration kMachineSlice = std::chrono::seconds(5);
constexpr Duration kUnwatched = std::chrono::hours(1);
constexpr int kLooksAtStopping = 20;
constexpr Duration kBetweenLooks = std::chrono::milliseconds(500);
constexpr double kCreeps = 5e-5;       // m or rad between two of these looks: more than encoders flicker
constexpr double kStandsStill = 1e-9;  // m or rad: less than any encoder shows

std::string Place(const MachineAxis& axis, double at) {
  return fmt::format("{:.6f} {}", at / axis.to_SI(), axis.unit());
}

AxisLimits LimitsOf(const MachineOptions& options, std::size_t axis) {
  return axis < options.axes.size() ? options.axes[axis] : AxisLimits{};
}

void CheckHealth(const MachineAxis& axis, const AxisState& state) {
  if (!state.referenced)
    throw DeviceFault(FaultKind::kRestarted, axis.name, "has lost its origin; its coordinates mean nothing");
  if (state.limit != 0) return;  // told apart by who asks
  if (!state.fault.empty()) throw DeviceFault(FaultKind::kRefused, axis.name, "reports " + state.fault);
}

/// Looks at a moving machine every second.
class MachineWatcher {
 public:
  MachineWatcher(MachineBench& bench, double takes_s, const MachineOptions& options)
      : bench_(bench), takes_s_(takes_s), options_(options) {}

  void Look() {
    const std::vector<AxisState> states = bench_.machine.State();
    looked_s_ += ToSeconds(kMachineLook);
    double stall_s = AxisLimits{}.stall_s, timeout_s = AxisLimits{}.move_timeout_s;
    bool stands = before_.size() == states.size();
    for (std::size_t k = 0; k < states.size(); ++k) {
      const MachineAxis& axis = bench_.machine.Axes()[k];
      CheckHealth(axis, states[k]);
      if (states[k].limit != 0) throw DeviceFault(FaultKind::kLimit, axis.name, "ran onto a limit switch");
      if (k < options_.axes.size()) {
        stall_s = options_.axes[k].stall_s;
        timeout_s = options_.axes[k].move_timeout_s;
      }
      stands = stands && std::abs(states[k].encoder - before_[k].encoder) < kStandsStill;
    }
    still_s_ = stands ? still_s_ + ToSeconds(kMachineLook) : 0.0;
    before_ = states;
    if (still_s_ >= stall_s) Stalled(states);
    if (looked_s_ > takes_s_ + timeout_s)
      throw DeviceFault(FaultKind::kNotInPosition, "machine",
                        fmt::format("not at the end of its path after {:.0f} s", looked_s_));
  }

  void CheckArrival() const {
    const std::vector<AxisState> states = bench_.machine.State();
    for (std::size_t k = 0; k < states.size(); ++k) {
      const MachineAxis& axis = bench_.machine.Axes()[k];
      CheckHealth(axis, states[k]);
      const double off = states[k].encoder - states[k].commanded;
      const bool on_switch = states[k].limit != 0;  // some controllers count it as the end of a motion
      if (!on_switch && (std::abs(off) <= LimitsOf(options_, k).in_position || std::isnan(off))) continue;
      throw DeviceFault(on_switch ? FaultKind::kLimit : FaultKind::kNotInPosition, axis.name,
                        fmt::format("was sent to {} and stands at {}{}", Place(axis, states[k].commanded),
                                    Place(axis, states[k].encoder), on_switch ? ", on a limit switch" : ""));
    }
  }

 private:
  [[noreturn]] void Stalled(const std::vector<AxisState>& states) const {
    std::string where;
    for (std::size_t k = 0; k < states.size(); ++k)
      where += (k > 0 ? ", " : "") + bench_.machine.Axes()[k].name + " " +
               Place(bench_.machine.Axes()[k], states[k].encoder);
    const bool all_there = std::ranges::all_of(
        states, [](const AxisState& s) { return std::abs(s.encoder - s.commanded) < kStandsStill; });
    throw DeviceFault(
        all_there ? FaultKind::kNotInPosition : FaultKind::kStalled, "machine",
        fmt::format("has stood still for {:.0f} s at {}{}", still_s_, where,
                    all_there ? ", where it was sent, but its controller does not say so" : ", on its way"));
  }

  MachineBench& bench_;
  double takes_s_;
  const MachineOptions& options_;
  std::vector<AxisState> before_;
  double looked_s_ = 0.0, still_s_ = 0.0;
};

/// Names of the axes that move, by what the controller says or by what their encoders do between two looks.
std::string Moving(const std::vector<MachineAxis>& axes, const std::vector<AxisState>& before,
                   const std::vector<AxisState>& now) {
  std::string names;
  for (std::size_t k = 0; k < now.size(); ++k) {
    const bool crept = k < before.size() && std::abs(now[k].encoder - before[k].encoder) > kCreeps;
    if (now[k].moving || crept) names += (names.empty() ? "" : ", ") + axes[k].name;
  }
  return names;
}

}  // namespace

Standstill StopMachine(MachineBench& bench) {
  try {
    bench.machine.Stop();
    std::string moving;
    std::vector<AxisState> before = bench.machine.State();
    for (int look = 0; look < kLooksAtStopping; ++look) {
      bench.clock.Wait(kBetweenLooks);
      const std::vector<AxisState> states = bench.machine.State();
      moving = Moving(bench.machine.Axes(), before, states);
      if (moving.empty()) return {true, ""};
      before = states;
    }
    return {false, "still moving after the stop: " + moving};
  } catch (const BenchError& error) {  // it may be the fault that is being dealt with
    return {false, error.what()};
  }
}

Standstill WhetherMachineStands(MachineBench& bench) {
  const std::vector<AxisState> before = bench.machine.State();
  std::string moving = Moving(bench.machine.Axes(), {}, before);
  if (moving.empty()) {  // else the rest of the way need not wait for a second look
    std::this_thread::sleep_for(kBetweenTwoLooks);
    moving = Moving(bench.machine.Axes(), before, bench.machine.State());
  }
  return {moving.empty(), moving.empty() ? "" : moving + " moves"};
}

void HearOperator(const MachineOptions& options) {
  if (options.stop_requested && options.stop_requested())
    throw DeviceFault(FaultKind::kStopped, "operator", "the run was stopped");
}

void WaitFor(MachineBench& bench, Duration duration, const MachineOptions& options) {
  while (options.log && duration > kMachineSlice) {  // nobody can say stop to a run that nobody writes down
    bench.clock.Wait(kMachineSlice);
    duration -= kMachineSlice;
    HearOperator(options);
  }
  if (duration > Duration(0)) bench.clock.Wait(duration);
}

void RequireMayGo(MachineBench& bench, const std::vector<double>& to, const MachineOptions& options) {
  const std::vector<AxisState> states = bench.machine.State();
  for (std::size_t k = 0; k < to.size(); ++k) {
    const MachineAxis& axis = bench.machine.Axes()[k];
    const AxisLimits limits = LimitsOf(options, k);
    if (to[k] < limits.lower || to[k] > limits.upper)
      throw DeviceFault(FaultKind::kLimit, axis.name,
                        fmt::format("{} lies outside the soft limits {} to {}", Place(axis, to[k]),
                                    Place(axis, limits.lower), Place(axis, limits.upper)));
    CheckHealth(axis, states[k]);
    if (states[k].limit * (to[k] - states[k].encoder) > 0.0)
      throw DeviceFault(FaultKind::kLimit, axis.name,
                        "stands on a limit switch and would be driven further onto it");
  }
}

std::vector<AxisState> RequireMayTurn(MachineBench& bench, const MachineOptions& options) {
  const std::vector<AxisState> states = bench.machine.State();
  for (std::size_t k = 0; k < states.size(); ++k) {
    const MachineAxis& axis = bench.machine.Axes()[k];
    CheckHealth(axis, states[k]);
    if (states[k].limit != 0) throw DeviceFault(FaultKind::kLimit, axis.name, "stands on a limit switch");
    const AxisLimits limits = LimitsOf(options, k);
    if (states[k].encoder < limits.lower || states[k].encoder > limits.upper)
      throw DeviceFault(FaultKind::kLimit, axis.name,
                        fmt::format("has come to {}, outside the soft limits {} to {}", Place(axis, states[k].encoder),
                                    Place(axis, limits.lower), Place(axis, limits.upper)));
  }
  return states;
}

void Watch(MachineBench& bench, double takes_s, const MachineOptions& options, const std::function<void()>& look) {
  MachineWatcher watcher(bench, takes_s, options);
  while (!bench.machine.Settles(options.log ? kMachineLook : kUnwatched)) {
    HearOperator(options);
    watcher.Look();
    if (look) look();
  }
  watcher.CheckArrival();
  if (look) look();
}

}  // namespace twinbench::procedure
