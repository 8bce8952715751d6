#include "twin/procedure/watch.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "twin/core/device_fault.h"
#include "twin/core/units.h"
#include "twin/procedure/rest.h"
#include "twin/procedure/whereabouts.h"

namespace twinbench::procedure {
namespace {

constexpr Duration kLook = std::chrono::seconds(1);
constexpr Duration kSlice = std::chrono::seconds(5);
constexpr double kThere_rad = 1.0 * units::arcsec;  // even where no tolerance was given
constexpr double kStandsStill_rad = 1e-9;           // less than any encoder shows

/// One table on its way.
class Watched {
 public:
  Watched(RotaryTable& table, const char* name, const TableLimits& limits, double to_rad, double sent_rad)
      : table_(table), name_(name), limits_(limits), to_rad_(to_rad), sent_rad_(sent_rad) {}

  /// Whatever speaks against this move, before it begins.
  void Check() {
    if (to_rad_ < limits_.lower_rad || to_rad_ > limits_.upper_rad) {
      Fail(FaultKind::kLimit, fmt::format("{:.6g} deg lies outside the soft limits {:.6g} to {:.6g} deg",
                                          Deg(to_rad_), Deg(limits_.lower_rad), Deg(limits_.upper_rad)));
    }
    const TableState state = table_.State();
    CheckHealth(state);
    if (std::abs(state.commanded_rad - sent_rad_) > kThere_rad)
      TellSentElsewhere({name_, true}, sent_rad_, state.commanded_rad);
    last_rad_ = state.encoder_rad;
    way_rad_ = to_rad_ - state.encoder_rad;
    nearest_rad_ = std::abs(way_rad_);
    if (state.limit * way_rad_ > 0.0) Fail(FaultKind::kLimit, "stands on a limit switch and would be driven further onto it");
  }

  void Start() { table_.StartMove(to_rad_); }

  bool Arrives() { return table_.Settles(kLook); }

  /// What it looks like after another second on the way.
  void Look() {
    looked_s_ += ToSeconds(kLook);
    const TableState state = table_.State();
    CheckHealth(state);
    if (state.limit != 0) Fail(FaultKind::kLimit, "ran onto a limit switch");
    CheckWay(state.encoder_rad);
    if (looked_s_ > limits_.move_timeout_s)
      Fail(FaultKind::kNotInPosition, fmt::format("not in position after {:.0f} s", looked_s_));
  }

  void CheckArrival() {
    const TableState state = table_.State();
    CheckHealth(state);
    const double off_rad = state.encoder_rad - to_rad_;
    // Some controllers count a switch as the end of a motion. Where the way led off it the switch may not have opened yet.
    const bool leaves_it = state.limit * way_rad_ < 0.0 && std::abs(off_rad) <= limits_.in_position_rad;
    if (state.limit != 0 && !leaves_it) Fail(FaultKind::kLimit, "stands on a limit switch");
    if (std::abs(off_rad) <= limits_.in_position_rad || std::isnan(off_rad)) return;
    Fail(FaultKind::kNotInPosition,
         fmt::format("was sent to {:.6f} deg and stands at {:.6f} deg, {:.3g} arcsec off", Deg(to_rad_),
                     Deg(state.encoder_rad), off_rad / units::arcsec));
  }

 private:
  static double Deg(double angle_rad) { return angle_rad / units::deg; }

  [[noreturn]] void Fail(FaultKind kind, const std::string& what) const { throw DeviceFault(kind, name_, what); }

  void CheckHealth(const TableState& state) const {
    if (!state.referenced) Fail(FaultKind::kRestarted, "has lost its origin; its angles mean nothing");
    if (!state.fault.empty() && state.limit == 0) Fail(FaultKind::kRefused, "reports " + state.fault);
  }

  void CheckWay(double encoder_rad) {
    const double left_rad = std::abs(to_rad_ - encoder_rad);
    if (left_rad > nearest_rad_ + limits_.following_rad)
      Fail(FaultKind::kFollowing,
           fmt::format("is {:.6f} deg away from its target and getting further", Deg(left_rad)));
    nearest_rad_ = std::min(nearest_rad_, left_rad);
    still_s_ = std::abs(encoder_rad - last_rad_) < kStandsStill_rad ? still_s_ + ToSeconds(kLook) : 0.0;
    last_rad_ = encoder_rad;
    if (still_s_ >= limits_.stall_s && left_rad <= std::min(limits_.in_position_rad, kThere_rad))
      Fail(FaultKind::kNotInPosition, "stands where it was sent, but its controller does not say so");
    if (still_s_ >= limits_.stall_s)
      Fail(FaultKind::kStalled, fmt::format("has stood still at {:.6f} deg for {:.0f} s on its way to {:.6f} deg",
                                            Deg(encoder_rad), still_s_, Deg(to_rad_)));
  }

  RotaryTable& table_;
  const char* name_;
  const TableLimits& limits_;
  double to_rad_, sent_rad_, way_rad_ = 0.0;
  double last_rad_ = kNaN, nearest_rad_ = kNaN;
  double still_s_ = 0.0, looked_s_ = 0.0;
};

std::vector<AxesLook> LooksAtBoth(RotaryBench& bench, const Options& options) {
  return {[&] { return LookAt(bench.target, "target", options.target); },
          [&] { return LookAt(bench.reference, "reference", options.reference); }};
}

}  // namespace

void HearOperator(const Options& options) {
  if (options.stop_requested && options.stop_requested())
    throw DeviceFault(FaultKind::kStopped, "operator", "the run was stopped");
}

void MoveBoth(RotaryBench& bench, double target_rad, double reference_rad, const Options& options, const std::array<double, 2>& sent_rad) {
  HearOperator(options);
  Watched target(bench.target, "target", options.target, target_rad, sent_rad[0]);
  Watched reference(bench.reference, "reference", options.reference, reference_rad, sent_rad[1]);
  for (Watched* table : {&target, &reference}) table->Check();
  for (Watched* table : {&target, &reference}) table->Start();
  for (Watched* table : {&target, &reference}) {
    while (!table->Arrives()) {
      HearOperator(options);
      table->Look();
    }
  }
  for (Watched* table : {&target, &reference}) table->CheckArrival();
}

void WaitFor(RotaryBench& bench, Duration duration, const Options& options) {
  // Nobody can say stop to a run that nobody writes down; elsewhere the slices are part of the record.
  while (options.log && duration > kSlice) {
    bench.clock.Wait(kSlice);
    duration -= kSlice;
    HearOperator(options);
  }
  bench.clock.Wait(duration);
}

Standstill StopBoth(RotaryBench& bench, const Options& options) {
  const std::vector<AxesLook> looks = LooksAtBoth(bench, options);
  return BringToRest(bench.clock, {{[&] { bench.target.Stop(); }, looks[0]}, {[&] { bench.reference.Stop(); }, looks[1]}});
}

Standstill WhetherBothStand(RotaryBench& bench, const Options& options) {
  return WhetherAtRest(LooksAtBoth(bench, options));
}

}  // namespace twinbench::procedure
