#include "twin/procedure/machine_watch.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "twin/core/device_fault.h"
#include "twin/procedure/rest.h"

namespace twinbench::procedure {
namespace {

constexpr Duration kMachineLook = std::chrono::seconds(1);
constexpr Duration kMachineSlice = std::chrono::seconds(5);
constexpr Duration kUnwatched = std::chrono::hours(1);
constexpr double kStandsStill = 1e-9;  // m or rad: less than any encoder shows

std::string Place(const MachineAxis& axis, double at) {
  return fmt::format("{:.6f} {}", at / axis.to_SI(), axis.unit());
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
  MachineWatcher(MachineBench& bench, double takes_s, const Whereabouts& where, const MachineOptions& options)
      : bench_(bench), takes_s_(takes_s), where_(where), options_(options) {}

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
      if (states[k].limit != 0)  // some controllers count it as the end of a motion
        throw DeviceFault(FaultKind::kLimit, axis.name, fmt::format("{}, on a limit switch", SentAndStands(k, states[k])));
    }
    where_.RequireOurs(states);
    for (std::size_t k = 0; k < states.size(); ++k) {
      if (!(std::abs(states[k].encoder - where_.Sent(k, states[k])) > where_.Tolerance(k))) continue;
      throw DeviceFault(FaultKind::kNotInPosition, bench_.machine.Axes()[k].name, SentAndStands(k, states[k]));
    }
  }

 private:
  std::string SentAndStands(std::size_t k, const AxisState& state) const {
    const MachineAxis& axis = bench_.machine.Axes()[k];
    return fmt::format("was sent to {} and stands at {}", Place(axis, where_.Sent(k, state)), Place(axis, state.encoder));
  }

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
  const Whereabouts& where_;
  const MachineOptions& options_;
  std::vector<AxisState> before_;
  double looked_s_ = 0.0, still_s_ = 0.0;
};

}  // namespace

Standstill StopMachine(MachineBench& bench, const MachineOptions& options) {
  return BringToRest(bench.clock, {{[&] { bench.machine.Stop(); }, [&] { return LookAt(bench.machine, options.axes); }}});
}

Standstill WhetherMachineStands(MachineBench& bench, const MachineOptions& options) {
  return WhetherAtRest({[&] { return LookAt(bench.machine, options.axes); }});
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

void RequireMayGo(const std::vector<MachineAxis>& axes, const std::vector<AxisState>& states, const std::vector<double>& to,
                  const MachineOptions& options) {
  for (std::size_t k = 0; k < to.size(); ++k) {
    const MachineAxis& axis = axes[k];
    const AxisLimits limits = LimitsOf(options.axes, k);
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
    const AxisLimits limits = LimitsOf(options.axes, k);
    if (states[k].encoder < limits.lower || states[k].encoder > limits.upper)
      throw DeviceFault(FaultKind::kLimit, axis.name,
                        fmt::format("has come to {}, outside the soft limits {} to {}", Place(axis, states[k].encoder),
                                    Place(axis, limits.lower), Place(axis, limits.upper)));
  }
  return states;
}

void Watch(MachineBench& bench, double takes_s, const Whereabouts& where, const MachineOptions& options,
           const std::function<void()>& look) {
  MachineWatcher watcher(bench, takes_s, where, options);
  while (!bench.machine.Settles(options.log ? kMachineLook : kUnwatched)) {
    HearOperator(options);
    watcher.Look();
    if (look) look();
  }
  watcher.CheckArrival();
  if (look) look();
}

}  // namespace twinbench::procedure
