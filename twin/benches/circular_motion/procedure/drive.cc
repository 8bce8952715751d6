#include "twin/benches/circular_motion/procedure.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "twin/benches/circular_motion/columns.h"
#include "twin/core/device_fault.h"

namespace twinbench::procedure {
namespace {

using namespace benches::circular;

constexpr double kLeadIn_rad = units::kPi;
constexpr double kRunOut_rad = 5.0 * units::deg;  // behind the last point, to slow down in
constexpr double kWithinReach_m = 0.5 * units::mm;  // of an instrument that is mounted
constexpr double kBesideTheCircle_m = 1.0 * units::um;
constexpr double kThere_rad = 1e-6;

/// The readings [first, end) of one way round.
struct Pass {
  int first = 0, end = 0;
};

std::vector<Pass> PassesOf(const std::vector<Reading>& plan) {
  std::vector<Pass> passes;
  for (std::size_t k = 0; k < plan.size(); ++k) {
    const int number = static_cast<int>(k);
    const bool begins = k == 0 || plan[k].setup != plan[k - 1].setup || plan[k].pass != plan[k - 1].pass;
    if (begins) passes.push_back({number, number});
    passes.back().end = number + 1;
  }
  return passes;
}

std::string InWords(const CircularSetup& setup) {
  const char* const bar = setup.ShowsAngle() ? "ball bar with its encoder" : "ball bar";
  return fmt::format("{}, radius {:.6g} mm", setup.IsBar() ? bar : setup.IsDrive() ? "scales of the drives" : "grid plate", setup.radius_m / units::mm);
}

/// The counter goes on from pass to pass; readings are told in the turn of the commanded angle.
void UnwrapEncoder(Reading& r) {
  const double turns = std::round((kEncoder_rad(static_cast<const Reading&>(r)) - r.target_rad) / units::turn);
  if (std::isfinite(turns) && turns != 0.0) kEncoder_rad(r) -= turns * units::turn;
}

class CircleDrive {
 public:
  CircleDrive(MachineSequencer& sequencer, const CircularProcedureSettings& settings)
      : sequencer_(sequencer), settings_(settings) {
    if (sequencer.axes().size() != 2 || sequencer.axes()[0].is_rotary || sequencer.axes()[1].is_rotary)
      throw DeviceFault(FaultKind::kRefused, "machine", "circles are driven with two linear axes, X and Y");
  }

  void CarryOut() {
    for (const Pass& pass : PassesOf(sequencer_.plan())) {
      const int from = sequencer_.From(pass.first, pass.end);
      if (from == pass.end) continue;
      const Reading& first = At(from);
      if (sequencer_.NeedsMounting(first.setup)) Mount(from);
      kFeed_m_s(first) > 0.0 ? Sweep(from, pass.end) : Stop(from, pass.end);
    }
  }

 private:
  const Reading& At(int reading) const { return sequencer_.plan()[static_cast<std::size_t>(reading)]; }

  void Mount(int reading) {
    const int setup = At(reading).setup;
    const CircularSetup& settings = settings_.setups[static_cast<std::size_t>(setup)];
    if (sequencer_.HasMounted()) sequencer_.Clear();
    sequencer_.MoveTo({kCommandedX_m(At(reading)), kCommandedY_m(At(reading))});
    sequencer_.Mount(setup, InWords(settings));
    if (setup > 0) sequencer_.Rest(reading, FromSeconds(settings_.remount_s));
  }

  /// On the circle, in the direction of the pass to an angle; a whole turn is none.
  void GoRoundTo(double angle_rad, double radius_m, int direction) {
    const std::vector<double> at = sequencer_.WhereSent();
    const double off_m = std::hypot(at[0], at[1]) - radius_m;
    if (std::abs(off_m) > kWithinReach_m)
      throw DeviceFault(
          FaultKind::kImplausible, "machine",
          fmt::format("stands {:.4g} mm off the circle with an instrument mounted; bring it back by hand",
                      off_m / units::mm));
    const std::vector<double> stands = sequencer_.Where();
    if (std::max(std::abs(off_m), std::abs(std::hypot(stands[0], stands[1]) - radius_m)) > kBesideTheCircle_m) {
      // where somebody else has left it, or it has crept to
      const double back = radius_m / (radius_m + off_m);
      sequencer_.MoveTo({at[0] * back, at[1] * back});
    }
    const double ahead_rad = direction * (angle_rad - std::atan2(at[1], at[0]));
    const double way_rad = ahead_rad - units::turn * std::floor(ahead_rad / units::turn);
    if (way_rad < kThere_rad || way_rad > units::turn - kThere_rad) return;
    sequencer_.Go({.sweep_rad = direction * way_rad});
  }

  void Sweep(int first, int end) {
    const Reading& begin = At(first);
    const double step_rad = units::turn / settings_.points;
    const double way_rad = kLeadIn_rad + (end - 1 - first) * step_rad + kRunOut_rad;
    GoRoundTo(begin.target_rad - begin.direction * kLeadIn_rad, Radius_m(begin), begin.direction);
    sequencer_.Sweep({.sweep_rad = begin.direction * way_rad,
                      .feed_m_s = kFeed_m_s(begin),
                      .triggers = end - first,
                      .first_trigger_rad = kLeadIn_rad,
                      .trigger_step_rad = step_rad},
                     first, end, At(begin, begin.target_rad + begin.direction * (way_rad - kLeadIn_rad)));
  }

  static Reading At(Reading there, double angle_rad) {
    const double radius_m = Radius_m(there);
    there.target_rad = angle_rad;
    kCommandedX_m(there) = radius_m * std::cos(angle_rad), kCommandedY_m(there) = radius_m * std::sin(angle_rad);
    return there;
  }

  void Stop(int first, int end) {
    const Reading& begin = At(first);
    const double step_rad = begin.direction * units::turn / settings_.stops;
    GoRoundTo(begin.target_rad - step_rad, Radius_m(begin), begin.direction);
    for (int k = first; k < end; ++k) {
      sequencer_.Go({.sweep_rad = step_rad, .feed_m_s = settings_.rapid_m_s});
      sequencer_.TakeAtRest(k, FromSeconds(settings_.dwell_s));
    }
  }

  MachineSequencer& sequencer_;
  const CircularProcedureSettings& settings_;
};

}  // namespace

void DriveCircles(MachineBench& bench, const Scenario& scenario, ReadingSink& sink,
                  const ProgressCallback& progress, const MachineOptions& options) {
  const CircularProcedureSettings& settings = CircularOf(scenario).procedure;
  const MachinePlan plan{WithAngles(CircleSchedule(settings)), scenario.bench, UnwrapEncoder};
  const auto way = [&](MachineSequencer& sequencer) { CircleDrive(sequencer, settings).CarryOut(); };
  CarryOutPlan(bench, plan, way, sink, progress, options);
}

}  // namespace twinbench::procedure
