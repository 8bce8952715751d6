#pragma once

#include "tests/support/faults.h"
#include "tests/support/memory_log.h"
#include "tests/support/rotary_scenario.h"
#include "tests/support/troubled_bench.h"
#include "twin/benches/rotary_4dof/procedure/procedure.h"
#include "twin/benches/rotary_4dof/twin/twin.h"

/// Runs with faults, and how they ended.
namespace twinbench::procedure {

/// What happens on the way; nothing by default.
struct Course {
  test::TroubledBench::Trouble before = {}, after = {};  // a call of a device
  Options options = {};
  bool is_written_down = true;
};

/// The device fails where it is asked for.
inline test::TroubledBench::Trouble FailsIf(
    const std::function<bool(const std::string& device, const std::string& request)>& is_now, FaultKind kind) {
  return [=](const std::string& device, const std::string& request, CallAnswer&) {
    if (is_now(device, request)) throw DeviceFault(kind, device, "as asked for");
  };
}

/// "gap of adc", or "none".
template <class Action>
std::string FaultIn(const Action& action) {
  const std::optional<DeviceFault> fault = test::FaultOf(action);
  return fault ? std::string(FaultName(fault->kind())) + " of " + fault->device() : "none";
}

/// Carries out the scenario's procedure on this bench.
/// @return FaultIn it.
inline std::string EndOn(RotaryBench inner, const Scenario& scenario, test::MemoryLog& log, Course course = {}) {
  test::TroubledBench troubled(inner, course.before, course.after);
  RotaryBench bench = course.before || course.after ? troubled.Bench() : inner;
  if (course.is_written_down) course.options.log = &log;
  return FaultIn([&] { CarryOut(bench, scenario, log, {}, course.options); });
}

/// The same on the scenario's twin.
inline std::string EndOnTwin(test::MemoryLog& log, const Course& course = {},
                             const Scenario& scenario = test::RestlessBench()) {
  sim::Twin twin(scenario);
  return EndOn(twin.Bench(), scenario, log, course);
}

}  // namespace twinbench::procedure
